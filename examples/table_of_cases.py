# %% [markdown]
# # Rows of a table, and back
#
# The cases in a pandas table become one batch, and the answers become a table with the same rows.
# The unit of a column is part of its name, and the column is passed on as a pint Quantity. A
# missing cell is NaN: its row is refused, with a status that says so, and the other rows are not
# affected. pandas is needed only here: the library takes arrays and gives lists.

# %%
import io

import numpy as np
import pandas as pd
import pint

import collisions as col

CHECKS = []


def check(label, ours, expected, within):
    """Remember a comparison; all of them are judged at the end."""
    good = abs(ours - expected) <= within
    CHECKS.append((f"{label}: {ours:.9g}, expected {expected:.9g}", good))


SHEET = """\
case,mass a [kg],speed a [km/h],mass b [lb],speed b [mph],restitution []
17-031,1500,50,2650,10,0.2
17-032,1500,50,,10,0.2
18-004,1320,62,3100,0,0.1
18-011,1800,30,2900,25,0.15
"""
table = pd.read_csv(io.StringIO(SHEET), index_col="case")
print(table.to_string())


# %% [markdown]
# ## From rows to a batch
#
# Each column has one unit, read from the square brackets. `to_numpy(float)` turns what pandas marks
# as missing into NaN. A column of text such as "50 km/h" would be refused, because a batch has one
# unit.


# %%
def column(name):
    """A column of the table with its unit."""
    (found,) = [title for title in table.columns if title.startswith(f"{name} [")]
    unit = found[len(name) + 2 : -1]
    return pint.Quantity(table[found].to_numpy(float), unit)


a = col.Vehicle(mass=column("mass a"), vx=column("speed a"))
b = col.Vehicle(mass=column("mass b"), vx=column("speed b"))
impact = col.linear_central(a, b, column("restitution"), on_failure="nan")

# %% [markdown]
# ## And back
#
# `to_columns` gives every input and result, one value per case in the order of the rows; the index
# is that of the table. `status` is a word: `not_finite` for the row with the missing mass,
# `separating` for the cars that move apart.

# %%
answers = pd.DataFrame(impact.to_columns(), index=table.index)
shown = ["status", "closing_speed", "a.delta_v", "b.delta_v", "energy_loss"]
print(answers[shown].round(3).to_string())

# %% [markdown]
# The columns are in SI. For another unit, take the Quantities and join them to the rows they came
# from:

# %%
report = table.assign(
    **{"delta-V b [km/h]": impact.q.b.delta_v.m_as("km/h"), "status": answers["status"]}
)
print(report[["delta-V b [km/h]", "status"]].round(1).to_string())
unanswered = answers[answers["refused"]]
print(
    f"{len(unanswered)} of {len(answers)} rows have no answer: "
    f"{', '.join(unanswered.index)}"
)

# %% [markdown]
# ## Checks
#
# The first row by hand: the closing speed of 9.418 m/s, times 1.2, times 1500 kg over the 2702 kg
# of both cars, is a delta-V of 6.27 m/s or 22.6 km/h. Every row with an answer must have the
# delta-V that conservation of momentum and the definition of restitution give, written out here;
# 1e-12 leaves room for a few rounding errors.

# %%
check("first row, km/h", report["delta-V b [km/h]"].iloc[0], 22.6, 0.05)
for case, row in table.iterrows():
    mass_a, mass_b = row["mass a [kg]"], row["mass b [lb]"] * 0.45359237
    closing = row["speed a [km/h]"] / 3.6 - row["speed b [mph]"] * 0.44704
    delta_v = (1.0 + row["restitution []"]) * closing * mass_a / (mass_a + mass_b)
    found = answers.loc[case]
    if found["status"] == "ok":
        check(f"{case}, delta-V of B", found["b.delta_v"], delta_v, 1e-12 * delta_v)
    else:
        none = bool(np.isnan(found["b.delta_v"]) and not delta_v > 0.0)
        CHECKS.append((f"{case} has no number", none))
CHECKS.append(("the index is kept", list(answers.index) == list(table.index)))
why = ["ok", "not_finite", "ok", "separating"]
CHECKS.append(("why", list(answers["status"]) == why))

failed = [label for label, good in CHECKS if not good]
if failed:
    raise AssertionError("these do not agree:\n" + "\n".join(failed))
print(f"{len(CHECKS)} comparisons")
print("all checks passed")
