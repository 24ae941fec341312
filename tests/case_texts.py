"""Case files that tests change: the examples, and one of each solver and study."""

from pathlib import Path

ROOT = Path(__file__).parents[1]
PLACED = 'yaw_inertia = 2000.0\nx = {x}\ny = 0.1\nheading = "0 deg"\n'
FILES = [
    *(path.read_text(encoding="utf-8") for path in sorted(
    (ROOT / "examples" / "cases").glob("*.toml"))),
    (ROOT / "src" / "collisions" / "cases" / "case_template.toml").read_text(encoding="utf-8"),
    '[a]\nmass = "1100 kg"\nvx = "80 km/h"\n[b]\nmass = 950\n[linear_central]\nrestitution = 0.4\n',
    ('[a]\nmass = 1100\nvx = 20.0\n[b]\nmass = inf\n[oblique_central]\nrestitution = "10 %"\n'
     'normal = [1, 0.2]\nfriction = 0.3\n'),
    ("[a]\nmass = 1500\nvx = 10.0\nx = -2.0\ny = 0.0\n[b]\nmass = 1200\nx = 2.0\ny = 0.0\n"
     "[solve]\nrestitution = 0.2\nnormal = 0.0\npoint = [0.0, 0.0]\nfriction = 0.5\ntolerance "
     "= 0.5\n"),
    (f'[a]\nmass = 1500\nvx = 14\n{PLACED.format(x=-2.0)}[b]\nmass = 1200\n'
     f'{PLACED.format(x=2.0)}[time_resolved]\nrestitution = 0.1\nnormal = 0\npoint = [0, '
     '0.1]\nfriction = 0.5\nduration = "100 ms"\nsteps = 20\n'),
    ('[reconstruct.central]\nmass_a = "1100 kg"\nmass_b = 950\nva = "80 km/h +/- 2 km/h (95 '
     '%)"\nvb = 0.0\nvb_after = "60 km/h"\n'),
    (f'[a_after]\nmass = 1100\nvx = 11.0\nvy = 0.4\n{PLACED.format(x=0.0)}[b_after]\nmass = '
     f'950\nvx = 13.0\nvy = 10.0\n{PLACED.format(x=2.5)}[reconstruct.planar]\nnormal = 0.0\n'
     'point = [1.6, 0.3]\nrestitution = 0.2\nfriction = 0.2\n'),
    (f'answer = 1\n[a]\nmass = 1500\n{PLACED.format(x=-2.0)}[b]\nmass = 1300\n'
     f'{PLACED.format(x=2.0)}'
     '[reconstruct.speeds]\ncourse_a = 0.0\ncourse_b = "90 deg"\ndelta_v_a = { Triangular = { '
     'low = 5.9, mode = 6, high = 6.1 } }\n'
     "energy_loss = 120000\nrestitution = 0.1\nnormal = 0.0\npoint = [0.0, 0.4]\nfriction = "
     "0.5\n"),
    ('[[mover]]\nname = "A"\nmass = 1500\nspeed = "12 m/s +/- 1 m/s"\ncourse = 0\nheading = 0\n'
     'x = -6\ny = 0.2\nyaw_inertia = 2500\noutline = [4.2, 1.8]\ndrag = 0.7\n[[mover]]\n'
     'name = "B"\n'
     'mass = 1200\nyaw_inertia = 1900\nheading = 0\nx = 0\ny = 0\noutline = [4, "1.7 m"]\n'
     'tyres = { friction = 0.7, lock = [1, 1, 0, 0.1], wheelbase = 2.6, track = 1.5 }\n'
     '[[contact]]\n'
     'a = "A"\nb = "B"\nat = "touch"\nrestitution = "0.1 .. 0.3"\nfriction = 0.5\n[[surface]]\n'
     'corners = [[3, -4], [9, -4], [9, 4]]\nfriction = 0.3\n[scene]\nslope = [0.01, 0]\n'
     'tolerance = 1e-3\n'),
    ('[a]\nmass = 1500\nvx = "10 m/s .. 20 m/s"\n[b]\nmass = 1200\n[linear_central]\n'
     'restitution = 0.1\n[fit.observed]\n"b.delta_v" = "9 m/s +/- 0.3 m/s"\n'),
]  # fmt: skip
# Takes the time of hundreds of others, and more the wider its priors are.
POSTERIOR = (
    '[a]\nmass = 1500\nvx = "10 m/s .. 20 m/s"\n[b]\nmass = 1200\n[linear_central]\nrestitution '
    '= "0.1 .. 0.3"\n[posterior]\nsamples = 512\n[posterior.observed]\n"b.delta_v" = "9 m/s +/- '
    '0.3 m/s"\n"a.before.vx" = "12 m/s .. 30 m/s"\n'
)
