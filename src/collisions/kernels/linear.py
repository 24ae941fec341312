"""Linear central impact: two point masses along one line (eqs 2 to 8 of the paper)."""

from typing import Any

from .central import shares
from .codes import EPS, GRAZING, IMMOVABLE, OK, OUT_OF_RANGE, SEPARATING, SPINNING, TRANSVERSE
from .select import verdict


def linear_central(
    restitution: Any,
    nx: Any,
    ny: Any,
    mass_a: Any,
    vx_a: Any,
    vy_a: Any,
    mass_b: Any,
    vx_b: Any,
    vy_b: Any,
    eps: float = EPS,
) -> tuple[Any, ...]:
    """Answers in the order of ``codes.OUTPUTS``; what is transverse is carried through unchanged."""
    share_a, share_b, effective_mass, immovable = shares(mass_a, mass_b)
    # Velocities are subtracted before anything else, so that a common motion of both bodies costs no digits.
    closing = -(nx * (vx_b - vx_a) + ny * (vy_b - vy_a))
    change = (1.0 + restitution) * closing
    compression = effective_mass * closing
    normal = effective_mass * change
    loss = 0.5 * (1.0 - restitution) * (closing * normal)
    dvn_a = -(share_a * change)
    dvn_b = share_b * change
    total = normal + loss + dvn_a + dvn_b
    fine = (closing > 0.0) & (total - total == 0.0)
    status = (
        OK
        if fine is True
        else verdict(
            (immovable, IMMOVABLE), (closing < 0.0, SEPARATING), (closing == 0.0, GRAZING), (total - total != 0.0, OUT_OF_RANGE)
        )
    )
    return (
        status, closing, 0.0, 0.0, normal, 0.0, compression, normal, 0.0, False, effective_mass, 0.0, loss, 0.0, loss,
        nx * normal, ny * normal, nx * dvn_a, ny * dvn_a, 0.0, nx * dvn_b, ny * dvn_b, 0.0,
    )  # fmt: skip


def outside_linear(
    nx: Any, ny: Any, spin_a: Any, vx_a: Any, vy_a: Any, spin_b: Any, vx_b: Any, vy_b: Any, eps: float = EPS
) -> Any:
    """Status of motion that the linear model cannot hold, 0 where there is none."""
    spins = (spin_a != 0.0) | (spin_b != 0.0)
    # What rounding leaves of motions along the normal is below 8 eps of the speeds, also after an impact has cancelled one.
    most = 8.0 * eps * (abs(nx * vx_a + ny * vy_a) + abs(nx * vx_b + ny * vy_b))
    across = (abs(nx * vy_a - ny * vx_a) > most) | (abs(nx * vy_b - ny * vx_b) > most)
    return OK if spins is False and across is False else verdict((spins, SPINNING), (across, TRANSVERSE))
