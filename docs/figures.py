"""The figures of the pages: the signs of the three impacts and of one vehicle, and those of reverse
reconstruction.

``python docs/figures.py [folder] [svg|png]`` writes them, by default again to docs/_static/ as SVG.
"""

import re
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle, FancyArrowPatch, Polygon

import collisions as col
from collisions import travel

INK, A, B, FORCE, FRAME, GREY = "#1a1a1a", "#1f5fa8", "#b3541e", "#a01040", "#2b7a3d", "#777777"
mpl.rcParams |= {
    "font.size": 11,
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavuserif",
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.fonttype": "path",
    "svg.hashsalt": "collisions",
}


def unit(degrees):
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])


def turned(v):
    return np.array([-v[1], v[0]])


def beside(place, dx, dy):
    return np.add(place, (dx, dy))


def canvas(ax, x, y):
    ax.set(xlim=x, ylim=y, aspect="equal")
    ax.axis("off")


def arrow(ax, start, end, colour, width=2.0, head=14, **style):
    ax.add_patch(
        FancyArrowPatch(
            start,
            end,
            arrowstyle="-|>",
            mutation_scale=head,
            lw=width,
            color=colour,
            shrinkA=0,
            shrinkB=0,
            **style,
        )
    )


def label(ax, place, text, colour=INK, **style):
    ax.text(*place, text, color=colour, **{"ha": "center", "va": "center", **style})


def turn(ax, centre, radius, start, end, colour):
    """An arc with a head at its end; clockwise where end < start."""
    angles = np.radians(np.linspace(start, end, 60))
    x, y = centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)
    ax.plot(x[:-4], y[:-4], color=colour, lw=1.6)
    arrow(ax, (x[-6], y[-6]), (x[-1], y[-1]), colour, width=1.2, head=11)


def car(ax, centre, heading, colour, name, length=4.4, width=1.8, name_at=(-1.3, 0.0)):
    """A rectangle with a windscreen and a nose, its centre of mass and its name."""
    h = unit(heading)
    axes = np.array([h, turned(h)])
    corners = np.array(
        [[-0.5, -0.5], [0.42, -0.5], [0.5, -0.3], [0.5, 0.3], [0.42, 0.5], [-0.5, 0.5]]
    ) * [length, width]
    ax.add_patch(Polygon(corners @ axes + centre, closed=True, fc=colour + "1f", ec=colour, lw=1.8))
    screen = np.array([[0.2, -0.4], [0.27, -0.32], [0.27, 0.32], [0.2, 0.4]]) * [length, width]
    ax.add_patch(Polygon(screen @ axes + centre, closed=True, fc=colour + "44", ec="none"))
    mass_centre(ax, centre, colour)
    label(ax, np.array(name_at) @ axes + centre, name, colour, fontsize=14, fontweight="bold")


def mass_centre(ax, centre, colour):
    ax.add_patch(Circle(centre, 0.11, fc="white", ec=colour, lw=1.8, zorder=5))
    ax.add_patch(Circle(centre, 0.04, fc=colour, ec=colour, zorder=6))


def scene_axes(ax, origin, size=1.3):
    origin = np.asarray(origin, float)
    arrow(ax, origin, beside(origin, size, 0), INK, 1.5, 12)
    arrow(ax, origin, beside(origin, 0, size), INK, 1.5, 12)
    label(ax, beside(origin, size + 0.22, 0), "$x$")
    label(ax, beside(origin, 0, size + 0.25), "$y$")
    ax.add_patch(Circle(origin, 0.13, fc="white", ec=INK, lw=1.2, zorder=5))
    ax.add_patch(Circle(origin, 0.035, fc=INK, ec=INK, zorder=6))
    label(ax, beside(origin, -0.32, -0.05), "$z$", ha="center")
    turn(ax, origin, 0.75 * size, 8, 68, INK)
    label(ax, origin + 1.02 * size * unit(40), "+", fontsize=12)


def contact_frame(ax, place, n, n_size, t_size, n_label, t_label):
    t = turned(n)
    arrow(ax, place, place + n_size * n, FRAME, 2.2)
    arrow(ax, place, place + t_size * t, FRAME, 2.2)
    label(ax, place + n_size * n + n_label, "$n$", FRAME, fontsize=14)
    label(ax, place + t_size * t + t_label, "$t$", FRAME, fontsize=14)


def linear():
    fig, (ax, force) = plt.subplots(1, 2, figsize=(10.5, 4.0), width_ratios=(2.1, 1))
    canvas(ax, (-6.4, 6.4), (-3.6, 3.3))
    place = np.array([0.0, 0.0])
    car(ax, (-2.2, 0), 0, A, "A")
    car(ax, (2.2, 0), 0, B, "B", name_at=(1.6, 0.0))
    ax.plot([-6.2, 6.2], [0, 0], color=GREY, lw=0.9, ls=(0, (6, 4)), zorder=0)
    arrow(ax, (-2.7, 1.35), (-0.5, 1.35), A)
    label(ax, (-1.6, 1.72), r"$v_A$", A)
    arrow(ax, (2.2, 1.35), (3.2, 1.35), B)
    label(ax, (2.7, 1.72), r"$v_B$", B)
    contact_frame(
        ax, place, np.array([1.0, 0.0]), 1.35, 2.4, np.array([0.0, 0.32]), np.array([0.3, 0.0])
    )
    arrow(ax, (0.15, -1.4), (2.3, -1.4), FORCE)
    label(ax, (2.4, -1.4), r"$P$ on B", FORCE, ha="left")
    arrow(ax, (-0.15, -1.4), (-2.3, -1.4), FORCE)
    label(ax, (-2.4, -1.4), r"$-P$ on A", FORCE, ha="right")
    label(ax, (4.0, 2.85), "line of impact through\nboth centres of mass", GREY, fontsize=9.5)
    ax.plot([5.3, 5.6], [2.4, 0.1], color=GREY, lw=0.8)
    scene_axes(ax, (-5.7, -3.2), 1.2)
    label(ax, (1.3, -2.75), r"closing speed $g = (v_A - v_B)\cdot n > 0$", fontsize=11.5)

    time = np.linspace(0, 1, 200)
    rise, fall = np.sin(np.pi / 2 * time), np.sin(np.pi / 2 * (1 - time))
    force.fill_between(time, rise, color="#d9a7b5", ec=FORCE, lw=1.6)
    force.fill_between(1 + 0.5 * time, 1.0 * fall, color="#f3e0e6", ec=FORCE, lw=1.6)
    force.text(0.62, 0.34, "$A_1$\ncompression\nimpulse", ha="center", va="center", fontsize=10)
    force.annotate(
        "$A_2$\nrestitution\nimpulse",
        (1.2, 0.3),
        (1.68, 0.86),
        ha="center",
        va="center",
        fontsize=10,
        arrowprops={"arrowstyle": "-", "color": INK},
    )
    force.set(
        xlim=(0, 2.05),
        ylim=(0, 1.22),
        xticks=[1.0, 1.5],
        xticklabels=["$t_1$", "$t_1+t_2$"],
        yticks=[],
    )
    force.set_xlabel("time")
    force.set_ylabel("force between A and B")
    force.set_title("restitution $e = A_2/A_1$", fontsize=11.5)
    force.spines[["top", "right"]].set_visible(False)
    fig.tight_layout()
    return fig


def oblique():
    fig, ax = plt.subplots(figsize=(9.0, 5.6))
    canvas(ax, (-7.2, 6.9), (-4.6, 4.4))
    angle = 20.0
    n, t = unit(angle), turned(unit(angle))
    place = np.array([0.0, 0.0])
    centre_a, centre_b = -2.1 * n, 2.1 * n
    for centre, colour, name in ((centre_a, A, "A"), (centre_b, B, "B")):
        ax.add_patch(Circle(centre, 2.1, fc=colour + "1a", ec=colour, lw=1.8))
        mass_centre(ax, centre, colour)
        label(ax, centre + 1.2 * t, name, colour, fontsize=15, fontweight="bold")
    ax.plot(*np.array([-6.2 * n, 6.6 * n]).T, color=GREY, lw=0.9, ls=(0, (6, 4)), zorder=0)
    ax.plot(*np.array([-3.9 * t, 3.9 * t]).T, color=GREY, lw=0.9, ls=(0, (2, 3)), zorder=0)
    # Angle of the normal, drawn where nothing else is.
    corner = 4.5 * n
    ax.plot([corner[0], corner[0] + 2.1], [corner[1]] * 2, color=INK, lw=0.8)
    turn(ax, corner, 1.5, 0, angle, INK)
    label(ax, beside(corner, 2.3, -0.28), r"$+x$", fontsize=10)
    label(ax, beside(corner, 1.1, -0.4), "normal angle", fontsize=10)
    contact_frame(ax, place, n, 1.5, 2.3, 0.42 * -t + 0.0 * n, 0.35 * n)
    # Velocities with their components along n and t.
    for centre, vn, vt, colour, text, at in (
        (centre_a, 1.7, -2.6, A, "$v_A$", (-1.12, 1.22)),
        (centre_b, -1.2, -2.9, B, "$v_B$", (-0.45, 0.1)),
    ):
        tip = centre + vn * n + vt * t
        arrow(ax, centre, tip, colour)
        ax.plot(*np.array([centre + vn * n, tip]).T, color=colour, lw=1.0, ls=":")
        ax.plot(*np.array([centre + vt * t, tip]).T, color=colour, lw=1.0, ls=":")
        ax.plot(*np.array([centre, centre + vt * t]).T, color=colour, lw=1.0, ls=":")
        label(ax, tip + at, text, colour, fontsize=13)
    # The impulse and its components, away from the bodies.
    p = 2.6 * n + 0.95 * t
    foot = np.array([2.6, -3.6])
    arrow(ax, foot, foot + p, FORCE, 2.2)
    ax.plot(*np.array([foot, foot + 2.6 * n, foot + p]).T, color=FORCE, lw=1.2, ls="--")
    label(ax, foot + 0.5 * p + [-0.2, 0.35], "$P$ on B", FORCE, ha="right")
    label(ax, foot + 1.56 * n - 0.32 * t, "$P_n$", FORCE)
    label(ax, foot + 3.0 * n + 0.48 * t, "$P_t$", FORCE)
    tail = np.array([-3.6, -2.3])
    arrow(ax, tail, tail - p, FORCE, 2.2)
    label(ax, tail - 0.5 * p + [0.3, -0.35], "$-P$ on A", FORCE, ha="left")
    label(
        ax,
        (-7.0, 3.9),
        "circles: point masses,\nno levers, no rotation",
        GREY,
        fontsize=10,
        ha="left",
    )
    label(
        ax,
        (1.3, 4.05),
        "line of impact (dashed)\nthrough both centres of mass",
        GREY,
        fontsize=10,
        ha="left",
    )
    scene_axes(ax, (-6.5, 0.6), 1.3)
    fig.tight_layout()
    return fig


def eccentric():
    fig, (ax, seen) = plt.subplots(1, 2, figsize=(11.5, 6.2), width_ratios=(1.75, 1))
    canvas(ax, (-6.4, 5.6), (-4.9, 5.3))
    heading_a, heading_b = 10.0, 100.0
    n = unit(10.0)
    t = turned(n)
    place = np.array([0.0, 0.0])
    centre_a = place - 2.2 * n - 0.45 * t
    centre_b = place + 0.9 * n - 1.25 * t
    car(ax, centre_a, heading_a, A, "A", name_at=(-1.7, 0.0))
    car(ax, centre_b, heading_b, B, "B", name_at=(-1.8, 0.0))
    ax.plot(*np.array([-6.0 * n, 5.3 * n]).T, color=GREY, lw=0.9, ls=(0, (6, 4)), zorder=0)
    label(ax, 4.5 * n + 0.35 * t, "line of impact", GREY, fontsize=10, rotation=10)
    # Levers from the centres of mass to the contact.
    for centre, text, at in (
        (centre_a, "$r_A$", -0.35 * n - 0.38 * t),
        (centre_b, "$r_B$", 0.38 * n + 0.1 * t),
    ):
        arrow(ax, centre, place, INK, 1.5, 12)
        label(ax, (centre + place) / 2 + at, text, fontsize=13)
    ax.add_patch(Circle(place, 0.1, color=INK, zorder=7))
    label(ax, beside(place, 0.25, 0.45), "C", fontsize=12)
    contact_frame(ax, place, n, 2.6, 2.6, -0.38 * t, -0.35 * n)
    # The impulse on B, and its opposite on A, in their own places.
    p = 2.0 * n - 0.62 * t
    arrow(ax, place, place + p, FORCE, 2.4)
    label(ax, place + p + [0.75, -0.12], "$P$ on B", FORCE)
    arrow(ax, place, place - p, FORCE, 2.4)
    label(ax, place - p + [-0.1, 0.45], "$-P$ on A", FORCE, ha="center")
    h = unit(heading_b)
    arrow(ax, centre_b + 2.2 * h, centre_b + 4.5 * h, B, 1.6, ls=(0, (4, 2)))
    label(ax, centre_b + 4.2 * h + [1.25, 0.2], "heading of B", B, fontsize=10.5)
    # Yaw, positive counter-clockwise.
    turn(ax, centre_b, 1.2, -125, -25, B)
    label(ax, centre_b + 1.95 * unit(-30), r"$+\omega_B$", B, fontsize=13)
    turn(ax, centre_a, 1.45, -130, -30, A)
    label(ax, centre_a + 1.85 * unit(-80), r"$+\omega_A$", A, fontsize=13)
    scene_axes(ax, (-5.7, -4.4), 1.3)
    label(
        ax,
        (-3.6, -4.05),
        "closing speed $g$ and slip $s$\nare those of the bodies\nat the contact point C",
        fontsize=10,
        ha="left",
    )

    canvas(seen, (-4.0, 4.0), (-4.6, 5.6))
    car(seen, (0, 0), 90, B, "", length=4.0, width=1.7)
    label(seen, (0, 5.3), "directions seen from a vehicle", fontsize=11.5)
    seen.plot([0, 0], [2.05, 3.3], color=GREY, lw=1, ls=":")
    label(seen, (0, 4.25), "PDOF 0\nfrom ahead", fontsize=10)
    label(seen, (3.2, 0), "+90°\nfrom the\nright", fontsize=10)
    label(seen, (-3.2, 0), "−90°\nfrom the\nleft", fontsize=10)
    label(seen, (0, -3.4), "180°\nfrom behind", fontsize=10)
    came = unit(90 - 50)
    arrow(seen, 3.5 * came, 0.25 * came, FORCE, 2.2)
    label(seen, 3.75 * came + [0.05, 0.55], "force\non the vehicle", FORCE, fontsize=10)
    turn(seen, (0, 0), 2.65, 90, 40, INK)
    label(seen, 3.05 * unit(68), "+PDOF", fontsize=10.5)
    arrow(seen, (0, 0), (0, 1.7), FRAME, 1.8)
    arrow(seen, (0, 0), (-1.7, 0), FRAME, 1.8)
    label(seen, (-0.42, 1.45), r"$\Delta v$" + "\nfwd", FRAME, fontsize=9)
    label(seen, (-1.5, 0.5), r"$\Delta v$" + " left", FRAME, fontsize=9)
    fig.tight_layout()
    return fig


def contact():
    """Closing speed and slip of a case, with the velocities of its contact points; drawn from the
    library's own answer.
    """
    normal = 20.0
    n, t = unit(normal), turned(unit(normal))
    centre_a, centre_b = -2.2 * n - 0.35 * t, 0.9 * n - 0.9 * t
    a = col.Vehicle.from_speed(
        mass=1500.0,
        yaw_inertia=2500.0,
        x=centre_a[0],
        y=centre_a[1],
        speed=3.2,
        course="-12 deg",
        yaw_rate=0.45,
    )
    b = col.Vehicle.from_speed(
        mass=1200.0,
        yaw_inertia=1900.0,
        x=centre_b[0],
        y=centre_b[1],
        speed=1.8,
        course="110 deg",
        yaw_rate=-0.35,
    )
    impact = col.eccentric(a, b, 0.1, normal=f"{normal} deg", point=(0.0, 0.0), friction=0.3)
    u_a, u_b = (np.array(vehicle.velocity_at((0.0, 0.0))) for vehicle in (a, b))
    fig, (ax, seen) = plt.subplots(1, 2, figsize=(10.6, 5.0), width_ratios=(1.45, 1))
    canvas(ax, (-5.6, 4.6), (-4.4, 4.4))
    car(ax, centre_a, normal, A, "A", name_at=(-1.7, 0.0))
    car(ax, centre_b, normal + 90.0, B, "B", name_at=(-1.8, 0.0))
    for centre, spin, colour, vehicle in ((centre_a, 1, A, a), (centre_b, -1, B, b)):
        velocity = np.array([vehicle.vx, vehicle.vy])
        arrow(ax, centre, centre + 0.62 * velocity, colour, 1.5, 11)
        start = -130.0 if spin > 0 else -35.0
        turn(ax, centre, 1.25, start, start + 85.0 * spin, colour)
    label(ax, centre_a + 0.62 * np.array([a.vx, a.vy]) + [-0.45, -0.3], "$v_A$", A)
    label(ax, centre_b + 0.62 * np.array([b.vx, b.vy]) + [0.45, -0.5], "$v_B$", B)
    label(ax, centre_a + 1.62 * unit(-75), r"$\omega_A > 0$", A)
    label(ax, centre_b + 1.75 * unit(-22) + [0.45, 0.0], r"$\omega_B < 0$", B)
    ax.add_patch(Circle((0, 0), 0.1, color=INK, zorder=7))
    label(ax, 0.45 * t + 0.2 * n, "C", fontsize=12)
    contact_frame(ax, np.zeros(2), n, 2.6, 2.9, -0.35 * t, -0.3 * n)
    scene_axes(ax, (-5.0, 2.4), 1.1)
    label(
        ax,
        (-5.4, -3.9),
        "the velocities of the two bodies at C differ\nfrom those of their centres: they turn",
        fontsize=10,
        ha="left",
    )

    canvas(seen, (-3.3, 4.3), (-3.6, 4.2))
    seen.plot(*np.array([-2.9 * n, 4.2 * n]).T, color=GREY, lw=0.9, ls=(0, (6, 4)), zorder=0)
    seen.plot(*np.array([-2.6 * t, 3.4 * t]).T, color=GREY, lw=0.9, ls=(0, (2, 3)), zorder=0)
    label(seen, 4.0 * n + 0.3 * t, "$n$", FRAME, fontsize=14)
    label(seen, 3.4 * t + 0.3 * n, "$t$", FRAME, fontsize=14)
    for velocity, colour, name, at in (
        (u_a, A, "$u_A$", [0.35, -0.1]),
        (u_b, B, "$u_B$", [0.35, 0.1]),
    ):
        arrow(seen, (0, 0), velocity, colour, 2.2)
        label(seen, velocity + at, name, colour, fontsize=13)
        for axis in (n, t):
            seen.plot(*np.array([velocity, velocity @ axis * axis]).T, color=colour, lw=1.0, ls=":")
    # What lies between the components: the closing speed along n, the slip along t.
    beside_n, beside_t = -2.35 * t, -1.6 * n
    arrow(seen, u_b @ n * n + beside_n, u_a @ n * n + beside_n, INK, 1.6, 11)
    label(
        seen,
        0.5 * (u_a + u_b) @ n * n + beside_n - 0.62 * t + [0.45, 0.0],
        f"closing speed\n$g = (u_A-u_B)\\cdot n$ = {impact.closing_speed:.1f} m/s",
        fontsize=10,
    )
    arrow(seen, u_a @ t * t + beside_t, u_b @ t * t + beside_t, INK, 1.6, 11)
    label(
        seen,
        u_b @ t * t + beside_t + 0.62 * t - [0.3, 0.0],
        f"slip\n$s = (u_B-u_A)\\cdot t$ = {impact.slip_before:.1f} m/s",
        fontsize=10,
    )
    seen.set_title("velocities at C", fontsize=11.5)
    fig.tight_layout()
    return fig


def one_vehicle():
    """Heading, course and yaw rate; a place on a vehicle; a pivot."""
    fig, (moving, place, pinned) = plt.subplots(1, 3, figsize=(10.8, 4.2))
    heading, course = 55.0, 20.0
    canvas(moving, (-3.4, 4.6), (-3.4, 4.6))
    moving.set_title("where it points, where it moves", fontsize=11.5)
    car(moving, (0, 0), heading, B, "")
    moving.plot([0, 4.2], [0, 0], color=INK, lw=0.8)
    label(moving, (4.2, -0.3), "$+x$", fontsize=10)
    arrow(moving, 2.2 * unit(heading), 4.3 * unit(heading), B, 1.6, ls=(0, (4, 2)))
    label(moving, 4.3 * unit(heading) + [-0.2, 0.1], "heading", B, ha="right")
    arrow(moving, (0, 0), 3.4 * unit(course), A, 2.2)
    label(moving, 3.4 * unit(course) + [0.0, 0.4], "$v$, course", A, ha="left")
    turn(moving, (0, 0), 2.6, 0, course, A)
    turn(moving, (0, 0), 3.1, 0, heading, B)
    label(moving, (2.05, 0.25), "+20°", A, fontsize=9.5)
    label(moving, 3.55 * unit(38), "+55°", B, fontsize=10)
    turn(moving, (0, 0), 1.5, 150, 250, INK)
    label(moving, 1.95 * unit(180), r"$+\omega$", fontsize=13)
    label(moving, (-3.3, -3.0), "crab angle = heading less course = +35°", fontsize=10, ha="left")

    canvas(place, (-3.4, 4.6), (-3.4, 4.6))
    place.set_title("a place on it: vehicle.point(...)", fontsize=11.5)
    heading, forward, left = 25.0, 1.9, 0.9
    distance, angle = np.hypot(forward, left), np.degrees(np.arctan2(left, forward))
    car(place, (0, 0), heading, B, "")
    vehicle = col.Vehicle(mass=1200.0, x=0.0, y=0.0, heading=f"{heading} deg")
    spot = np.array(vehicle.point(forward=forward, left=left))
    np.testing.assert_allclose(
        spot, vehicle.point(distance=distance, angle=f"{angle} deg"), rtol=0.0, atol=1e-12
    )
    ahead = forward * unit(heading)
    place.plot(*np.array([ahead, 4.4 * unit(heading)]).T, color=GREY, lw=0.9, ls=":")
    arrow(place, (0, 0), ahead, FRAME, 2.0)
    arrow(place, ahead, spot, FRAME, 2.0)
    arrow(place, (0, 0), spot, INK, 1.5, 11)
    place.add_patch(Circle(spot, 0.1, color=INK, zorder=7))
    label(place, 0.48 * ahead - 0.42 * turned(unit(heading)), "forward", FRAME, rotation=heading)
    label(place, 0.5 * (ahead + spot) + [0.55, 0.1], "left", FRAME, fontsize=10)
    label(place, (-2.6, 2.6), "distance", INK)
    place.plot([-1.9, 0.45 * spot[0]], [2.45, 0.45 * spot[1]], color=GREY, lw=0.8)
    turn(place, (0, 0), 3.2, heading, heading + angle, INK)
    place.plot(*np.array([spot, 3.3 * unit(heading + angle)]).T, color=GREY, lw=0.9, ls=":")
    label(place, 3.55 * unit(heading + 0.5 * angle) + [0.3, 0.25], "+angle", ha="left")
    label(place, (-3.3, -3.0), "to the right: left < 0, angle < 0", fontsize=10, ha="left")

    canvas(pinned, (-3.4, 4.6), (-3.4, 4.6))
    pinned.set_title("a body that turns about a pivot", fontsize=11.5)
    heading = 65.0
    pivot = np.array([-1.0, -2.0])
    centre, struck = pivot + 2.1 * unit(heading), pivot + 4.1 * unit(heading)
    body = col.Vehicle(
        mass=1000.0, yaw_inertia=1333.0, x=centre[0], y=centre[1], pivot=tuple(pivot)
    )
    other = col.Vehicle.from_speed(
        mass=900.0,
        yaw_inertia=np.inf,
        x=struck[0],
        y=struck[1],
        speed=10.0,
        course=np.radians(heading - 90.0),
    )
    side = col.eccentric(
        other, body, 0.2, normal=np.radians(heading - 90.0), point=tuple(struck), friction=0.0
    ).b
    car(pinned, centre, heading, B, "")
    pinned.add_patch(Circle(pivot, 0.17, fc="white", ec=INK, lw=2.0, zorder=7))
    label(pinned, beside(pivot, -0.4, -0.62), "pivot O", INK)
    arrow(pinned, pivot + 0.17 * unit(heading), centre, INK, 1.4, 10)
    label(pinned, 0.5 * (pivot + centre) + [-0.5, 0.2], "arm", INK, fontsize=10)
    velocity = np.array([side.after.vx, side.after.vy])
    arrow(pinned, centre, centre + 0.55 * velocity, B, 2.2)
    label(pinned, centre + 0.55 * velocity + [0.15, -0.35], "velocity after", B, fontsize=10)
    turn(pinned, pivot, 3.6, heading - 12.0, heading - 42.0, INK)
    label(pinned, pivot + 4.65 * unit(heading - 29.0), r"$\omega < 0$", fontsize=13)
    for place_of, impulse in (
        (struck, np.array([side.impulse_x, side.impulse_y])),
        (pivot, np.array([side.pivot_impulse_x, side.pivot_impulse_y])),
    ):
        arrow(
            pinned,
            place_of - 6e-4 * impulse - 0.2 * unit(heading - 90.0),
            place_of - 0.2 * unit(heading - 90.0),
            FORCE,
            2.2,
        )
    label(pinned, beside(struck, -1.7, 1.7), "$P$ on B", FORCE)
    label(pinned, beside(pivot, -1.6, 1.35), "pivot\nimpulse", FORCE, fontsize=10)
    fig.tight_layout()
    return fig


def seen_from_vehicle():
    """PDOF on the clock face, and delta-V in the axes of a vehicle and of a recorder; drawn from
    the library's own answer.
    """
    a = col.Vehicle(
        mass="1500 kg", yaw_inertia="2400 kg*m**2", vx="50 km/h", x=-2.0, y=0.4, heading="0 deg"
    )
    b = col.Vehicle(
        mass="1200 kg", yaw_inertia="1700 kg*m**2", vy="40 km/h", x=0.8, y=-1.2, heading="90 deg"
    )
    side = col.eccentric(a, b, 0.1, normal="0 deg", point=(0.0, 0.0), friction=0.5).b
    fig, (clock, change) = plt.subplots(1, 2, figsize=(11.5, 5.8))
    canvas(clock, (-5.2, 5.2), (-4.9, 4.9))
    clock.set_title("where the force comes from", fontsize=11.5)
    clock.add_patch(Circle((0, 0), 3.0, fc="none", ec=GREY, lw=0.9))
    for hour in range(1, 13):
        degrees = (30 * hour + 180) % 360 - 180 or 0
        at = unit(90 - 30 * hour)
        clock.plot(*np.array([2.9 * at, 3.1 * at]).T, color=GREY, lw=1.2)
        number = (
            f"{degrees:+d}°".replace("-", "\N{MINUS SIGN}")
            if degrees % 180
            else "180°"
            if degrees
            else "0"
        )
        label(clock, 3.6 * at, f"{hour}", fontsize=12, fontweight="bold")
        label(clock, 4.45 * at, number, GREY, fontsize=9.5)
    car(clock, (0, 0), 90, B, "", length=3.6, width=1.5)
    came = unit(90 - np.degrees(side.pdof))
    arrow(clock, 2.8 * came, 0.15 * came, FORCE, 2.4)
    told = f"pdof {np.degrees(side.pdof):.0f}°\npdof_clock {side.pdof_clock}".replace(
        "-", "\N{MINUS SIGN}"
    )
    label(clock, (0.0, -2.32), told, FORCE, fontsize=9.5)

    canvas(change, (-5.2, 5.2), (-4.9, 4.9))
    change.set_title("the same impact as delta-V of the vehicle", fontsize=11.5)
    car(change, (0, 0), 90, B, "", length=3.6, width=1.5)
    scale = 0.5
    tip = scale * np.array([-side.delta_v_left, side.delta_v_forward])
    arrow(change, (0, 0), tip, FORCE, 2.4)
    change.plot(*np.array([(tip[0], 0), tip, (0, tip[1])]).T, color=FORCE, lw=1.0, ls=":")
    label(change, beside(tip, 0.2, -0.4), f"delta_v {side.delta_v:.1f} m/s", FORCE, ha="left")
    for end, text, at, colour in (
        ((0, 3.4), "delta_v_forward", (0, 3.75), FRAME),
        ((-3.0, 0), "delta_v_left", (-3.2, 0.45), FRAME),
        ((3.0, 0), "recorder: lateral,\npositive to the right", (3.4, 0.75), GREY),
    ):
        arrow(change, (0, 0), end, colour, 1.8)
        label(change, at, text, colour, fontsize=10.5)
    change.text(
        0.0,
        -4.3,
        (
            f"delta_v_forward {side.delta_v_forward:+.1f} m/s, "
            f"delta_v_left {side.delta_v_left:+.1f} m/s\n"
            f"a recorder shows {side.delta_v_forward:+.1f} and {-side.delta_v_left:+.1f} m/s"
        ).replace("-", "\N{MINUS SIGN}"),
        ha="center",
        va="center",
        fontsize=10.5,
    )
    fig.tight_layout()
    return fig


def crossing_courses():
    """The car of 1200 kg going south and the one of 1800 kg going east, with departure courses
    known to 5 degrees.
    """
    fig, (ax, firm) = plt.subplots(1, 2, figsize=(11.5, 5.0), width_ratios=(1.5, 1))
    canvas(ax, (-8.0, 125.0), (-98.0, 13.0))
    masses, speeds, courses = (1.2, 1.8), (30.0, 50.0), (-30.0, -40.0)  # t, km/h, deg
    after = [
        mass * speed * unit(course)
        for mass, speed, course in zip(masses, speeds, courses, strict=True)
    ]
    total = after[0] + after[1]
    swept = np.linspace(-5.0, 5.0, 41)
    for tail, mass, speed, course, colour in zip(
        (np.zeros(2), after[0]), masses, speeds, courses, (A, B), strict=True
    ):
        fan = np.array([tail, *(tail + mass * speed * unit(course + angle) for angle in swept)])
        ax.add_patch(Polygon(fan, closed=True, fc=colour + "22", ec="none"))
    one, other = np.meshgrid(swept, swept)
    tips = sum(
        mass
        * speed
        * np.array([np.cos(np.radians(course + angle)), np.sin(np.radians(course + angle))])
        for mass, speed, course, angle in zip(masses, speeds, courses, (one, other), strict=True)
    )
    rim = tips[:, [0, -1], :].reshape(2, -1), tips[:, :, [0, -1]].reshape(2, -1)
    cloud = np.concatenate(rim, axis=1)
    hull = hull_of(cloud.T)
    ax.add_patch(Polygon(hull, closed=True, fc=FORCE + "44", ec=FORCE, lw=1.0, zorder=4))
    (left, right), (low, high) = ((cloud[i].min(), cloud[i].max()) for i in range(2))
    for ends in (((left, 0), (left, low)), ((right, 0), (right, low))):
        ax.plot(*np.array(ends).T, color=GREY, lw=0.8, ls=":")
    for y in (low, high):
        ax.plot([0, right], [y, y], color=GREY, lw=0.8, ls=":")
    arrow(ax, (0, 0), after[0], A)
    arrow(ax, after[0], total, B)
    arrow(ax, (0, 0), total, INK, 1.6, ls=(0, (5, 3)))
    arrow(ax, (0, 0), (0, total[1]), A, 2.6)
    arrow(ax, (0, 0), (total[0], 0), B, 2.6)
    ax.plot([left, right], [2.2, 2.2], color=B, lw=5, solid_capstyle="butt", alpha=0.5)
    ax.plot([-2.2, -2.2], [low, high], color=A, lw=5, solid_capstyle="butt", alpha=0.5)
    label(ax, (52, 6.5), "B before: $m_B v_B$ along its course", B)
    label(ax, (-6.2, -34), "A before: $m_A v_A$", A, rotation=90)
    label(ax, after[0] * 0.62 + [3.0, 5.2], "A after", A, rotation=-30)
    label(ax, after[0] + 0.5 * after[1] + [4.5, 4.5], "B after", B, rotation=-40)
    label(ax, total * 0.42 + [-4.5, -6.5], "total", INK, rotation=-37)
    label(
        ax,
        (right, low - 5.0),
        "tip of the total,\ncourses after within ±5°",
        FORCE,
        fontsize=10,
        va="top",
    )
    label(ax, (0.5 * (left + right), 7.5), "its range", B, fontsize=9.5)
    arrow(ax, (4, -93), (44, -93), INK, 1.2, 10)
    label(ax, (47, -93), "40 000 kg km/h", fontsize=9.5, ha="left")

    angle = np.linspace(1.5, 178.5, 500)
    condition = (1.0 + abs(np.cos(np.radians(angle)))) / np.sin(np.radians(angle))
    firm.semilogy(angle, condition, color=FORCE, lw=2)
    for start, end in ((0, 10), (170, 180)):
        firm.axvspan(start, end, color=GREY, alpha=0.25, lw=0)
    firm.text(13, 45, "warned of below 10°\nand above 170°", fontsize=10, va="center")
    firm.set(xlim=(0, 180), ylim=(0.8, 100), xticks=range(0, 181, 30))
    firm.set_xlabel("angle between the unknown courses, degrees")
    firm.set_ylabel("condition")
    firm.set_yticks([1, 2, 5, 10, 20, 50, 100], labels=["1", "2", "5", "10", "20", "50", "100"])
    firm.minorticks_off()
    firm.grid(color="#dddddd", lw=0.6)
    firm.spines[["top", "right"]].set_visible(False)
    fig.tight_layout()
    return fig


def hull_of(points):
    """The outer corners of a cloud of points, counter-clockwise."""
    ordered = sorted(map(tuple, points))

    def chain(places):
        kept = []
        for place in places:
            while (
                len(kept) > 1
                and cross(np.subtract(kept[-1], kept[-2]), np.subtract(place, kept[-1])) <= 0.0
            ):
                kept.pop()
            kept.append(place)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def cross(one, other):
    return one[0] * other[1] - one[1] * other[0]


def run_out():
    """Car B of examples/intersection_reconstruction.py."""
    places = [
        (0.8, -0.7),
        (2.4, 1.9),
        (4.0, 4.4),
        (5.4, 6.5),
        (7.2, 9.0),
        (8.7, 11.0),
        (10.2, 13.0),
        (13.0, 16.5),
    ]
    headings = [90, 50, 15, -15, -55, -80, -100, -105]
    friction, lock = [0.7] * 4 + [0.45] * 3, 0.3
    run = travel.path(
        places, [f"{heading} deg" for heading in headings], friction=friction, lock=lock
    )
    fig, (ax, drag) = plt.subplots(1, 2, figsize=(11.5, 6.6), width_ratios=(1.25, 1))
    canvas(ax, (-4.0, 17.5), (-4.2, 20.0))
    ax.axhspan(9.0, 20.0, color="#7fae6a", alpha=0.22, lw=0)
    label(ax, (-3.6, 10.1), "grass, friction 0.45", GREY, fontsize=9.5, ha="left")
    label(ax, (-3.6, 7.9), "asphalt, friction 0.7", GREY, fontsize=9.5, ha="left")
    for place, heading in zip(places, headings, strict=True):
        car(ax, place, heading, B, "", length=4.2, width=1.75)
    ax.plot(*np.array(places).T, color=INK, lw=1.6, zorder=7)
    start = np.array(places[0])
    ax.plot(*np.array([start, places[-1]]).T, color=GREY, lw=1.4, ls=(0, (6, 4)), zorder=7)
    arrow(ax, start, start + 9.0 * unit(np.degrees(run.course)), FORCE, 2.4, zorder=8)
    label(
        ax,
        start + 4.2 * unit(np.degrees(run.course)) + [-2.9, 0.6],
        f"tangent\n{np.degrees(run.course):.1f}°",
        FORCE,
        ha="right",
    )
    label(
        ax,
        (12.6, 10.9),
        f"straight line\nto rest {np.degrees(run.straight_course):.1f}°",
        GREY,
        ha="left",
        fontsize=10,
    )
    ax.plot([12.4, 9.1], [10.9, 10.75], color=GREY, lw=0.8)
    label(ax, beside(start, 2.6, -1.9), "separation", ha="left")
    label(ax, np.add(places[-1], (0.2, 2.9)), "rest", ha="center")
    scene_axes(ax, (11.5, -3.2), 1.5)

    crab = np.linspace(-180.0, 180.0, 721)

    def braked(lock, angle):
        along = np.minimum(lock, np.abs(np.cos(angle)))
        return along * np.abs(np.cos(angle)) + np.sqrt(1.0 - along**2) * np.abs(np.sin(angle))

    for part, style in (
        (0.0, (0, (1, 1.5))),
        (0.3, "-"),
        (0.6, (0, (5, 2))),
        (1.0, (0, (7, 2, 1, 2))),
    ):
        angle = np.radians(crab)
        drag.plot(crab, braked(part, angle), color=INK, lw=1.5, ls=style, label=f"lock {part:g}")
    for angle, found, mu in zip(run.crab_angles, run.drags, friction, strict=True):
        drag.plot(np.degrees(angle), found / mu, "o", color=B, ms=7, zorder=5)
    drag.set(xlim=(-180, 180), ylim=(0, 1.05), xticks=range(-180, 181, 60))
    drag.set_xlabel("crab angle, degrees (heading less course)")
    drag.set_ylabel("drag / friction")
    drag.set_title("points: the segments of this run-out", fontsize=10.5)
    drag.legend(loc="lower right", frameon=True, framealpha=0.95)
    drag.grid(color="#dddddd", lw=0.6)
    drag.spines[["top", "right"]].set_visible(False)
    fig.tight_layout()
    return fig


FIGURES = {
    "signs_linear_central": linear,
    "signs_oblique_central": oblique,
    "signs_eccentric": eccentric,
    "signs_contact": contact,
    "signs_vehicle": one_vehicle,
    "signs_seen_from_vehicle": seen_from_vehicle,
    "reverse_courses": crossing_courses,
    "reverse_run_out": run_out,
}


def main(folder=Path(__file__).parent / "_static", kind="svg"):
    blank = {
        "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
        "png": {"Software": None},
    }
    for name, draw in FIGURES.items():
        fig = draw()
        path = Path(folder) / f"{name}.{kind}"
        fig.savefig(path, metadata=blank[kind], dpi=110)
        if kind == "svg":  # browsers need no document type, and nothing should point elsewhere
            path.write_text(
                re.sub(r"<!DOCTYPE[^>]*>\s*", "", path.read_text(encoding="utf-8")),
                encoding="utf-8",
            )
        plt.close(fig)


if __name__ == "__main__":
    main(*sys.argv[1:])
