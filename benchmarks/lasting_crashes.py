"""Crashes of two cars whose contact lasts, integrated in time, sharing no code with the package.

It is a world of its own to try the package's answers in: what the package assumes of an impact is
not assumed here.

*Contact.* Each body carries the point of first touch with it. The force acts midway between the
two points; its normal turns by the mean of what both bodies turn. Along the normal a spring with a
stiffer line of unloading gives back ``restitution**2`` of the work that it took. Across it friction
opposes the slip with ``friction`` times the normal force times slip / hypot(slip, ``CREEP``). With
this point and this normal the rate of the penetration is exactly the closing velocity of the
material at the point, so momentum, moment of momentum and energy balance to the error of the
integration. The contact ends where the force has fallen to 0; a second one is not looked for.

*Tyres.* Four wheels a car, each with a spin of its own. The force of a wheel opposes the slip of
its tread over the ground and grows with slip over rolling speed as in the brush model (Fiala's
cubic, then ``ground`` times load). A brake is a moment, ``lock`` times what would hold the wheel
under its load at rest: above 1 the wheel locks. The loads follow the tyres' forces through the
height of the centre of mass with the lag of a suspension; the force of the contact is taken to act
at that height. Slip near rest and the moment of a brake near rest are smoothed (``SLOW``,
``STILL``).

All numbers are SI; scene axes are right-handed, angles counter-clockwise. The last axis of an array
is the crash, the first the car (A, B), and of what belongs to wheels the second is the wheel: front
left, front right, rear left, rear right.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

GRAVITY = 9.81
STEPS = 4000  # of the nominal duration of a contact
LONGEST = 3.0  # nominal durations, after which a contact that has not ended counts as unfinished
EVERY = 8  # steps between the kept moments of a pulse
CREEP = 0.01  # m/s, slip at which friction has 0.7 of its bound
SLOW = 0.3  # m/s, added to the speed of rolling in the slip of a tyre
OUT_OF_CONTACT = 1.0  # m/s, the same after separation, for the sake of longer steps
RESTING = 0.05  # m/s, of the energy at which a car counts as at rest
STILL = 0.5  # rad/s, spin at which a brake has 0.7 of its moment
LAG = 0.05  # s, of the loads behind the forces
RUN_IN = 0.3  # s, of the wheels before first touch
LEAST = 0.01  # of the restitution: below, the line of unloading is too steep to follow

# Rows of a state, of each car; the tyres' moment is about the origin. The last, the heat of
# friction, is of the contact and stands in A's place.
X, Y, HEADING, VX, VY, YAW_RATE = range(6)
SPIN = slice(6, 10)
LAGGING_ALONG, LAGGING_ACROSS = 10, 11  # force of the tyres that the loads have followed so far
FORWARD, LEFT, SQUARED_YAW = 12, 13, 14  # integrals of the acceleration in turning axes
TYRE_X, TYRE_Y, TYRE_MOMENT, TYRE_WORK, HEAT = range(15, 20)
ROWS = 20
INNER = slice(6, 12)  # what runs in before first touch


@dataclass(frozen=True, kw_only=True)
class Crashes:
    """Crashes at first touch, arrays as the module says."""

    mass: Any
    inertia: Any
    x: Any
    y: Any
    heading: Any
    vx: Any
    vy: Any
    yaw_rate: Any
    point: Any  # (2, crashes): x and y
    normal: Any  # angle from A into B
    stiffness: Any  # N/m, of the contact
    restitution: Any
    friction: Any
    nominal: Any  # s, about how long the contact will last; sets the step of the integration only
    ground: Any  # friction of the ground; 0 leaves the tyres out
    lock: Any  # (2, 4, crashes)
    wheelbase: Any
    ahead: Any  # of the wheelbase, the share between the front axle and the centre of mass
    track: Any
    height: Any
    cornering: Any  # 1/rad, stiffness of the tyres over their load
    radius: Any
    spin_inertia: Any  # kg m2, of one wheel

    def take(self, which: Any) -> Crashes:
        """Some of the crashes."""
        names = [one.name for one in fields(self)]
        return replace(self, **{name: getattr(self, name)[..., which] for name in names})

    def instant(self, duration: float = 0.002) -> Crashes:
        """The same crashes with contacts that last about so long, and without tyres."""
        stiffness = self.stiffness * (self.nominal / duration) ** 2
        nominal, ground = np.full_like(self.nominal, duration), np.zeros_like(self.ground)
        return replace(self, stiffness=stiffness, nominal=nominal, ground=ground)

    def mirrored(self) -> Crashes:
        """The same crashes seen in a mirror along the x axis."""
        names = ("y", "heading", "vy", "yaw_rate", "normal")
        turned = {name: -getattr(self, name) for name in names}
        point = self.point * np.array([[1.0], [-1.0]])
        return replace(self, point=point, lock=self.lock[:, [1, 0, 3, 2]], **turned)


@dataclass(frozen=True, kw_only=True)
class Contacts:
    """What became of crashes: arrays as the module says."""

    ended: Any  # whether the contact ended in the time that was watched
    duration: Any
    penetration: Any  # m, at maximum engagement
    slip: Any  # m/s, of A over B across the normal at separation
    ratio: Any  # impulse on B across the normal over that along it, that of maximum engagement
    peak_ratio: Any  # the largest ratio of the forces
    # At maximum engagement:
    engaged: Any  # s
    x: Any
    y: Any
    heading: Any
    point: Any
    normal: Any
    # At separation:
    after: Any  # (2, ROWS, crashes), the whole state
    impulse: Any  # (2, 2, crashes), of the contact on each car: x and y
    # The kept moments: (moments, crashes), and (moments, 2, crashes) of each car.
    time: Any
    recorded_forward: Any
    recorded_left: Any
    turned: Any  # yaw rate since first touch
    squared_yaw: Any
    # Energy: what both cars had before and after, and where it went.
    energy_before: Any
    energy_after: Any
    lost_along: Any
    heat: Any
    tyre_work: Any

    @property
    def stuck(self) -> Any:
        """Whether the contact ended without slip to speak of."""
        return np.abs(self.slip) < 0.5

    def fixed(self, crashes: Crashes) -> tuple[Any, Any]:
        """Delta-V forward and left, (2, crashes), heading as at maximum engagement."""
        dvx, dvy = self.after[:, VX] - crashes.vx, self.after[:, VY] - crashes.vy
        c, s = np.cos(self.heading), np.sin(self.heading)
        return c * dvx + s * dvy, c * dvy - s * dvx

    def turning(self, forward: Any = 0.0, left: Any = 0.0) -> tuple[Any, Any]:
        """Curves of delta-V forward and left, (moments, 2, crashes), of a recorder at this place.

        It integrates the acceleration of its own place along axes that turn with the car. The last
        moment is separation.
        """
        along = self.recorded_forward - self.turned * left - self.squared_yaw * forward
        return along, self.recorded_left + self.turned * forward - self.squared_yaw * left

    def sampled(self, i: int, forward: Any = 0.0, left: Any = 0.0) -> tuple[Any, Any, Any]:
        """Moments every 10 ms up to separation, and both curves of one crash, (moments, 2)."""
        at = np.append(np.arange(0.0, self.duration[i], 0.01), self.duration[i])
        curves = [curve[:, :, i].T for curve in self.turning(forward, left)]
        read = [[np.interp(at, self.time[:, i], one) for one in curve] for curve in curves]
        return at, np.stack(read[0], axis=-1), np.stack(read[1], axis=-1)


class World:
    """Crashes as a system of differential equations."""

    def __init__(self, crashes: Crashes, *, creep: float = CREEP, slow: float = SLOW) -> None:
        self.crashes, self.creep, self.slow = crashes, creep, slow
        k = crashes
        self.arm_x, self.arm_y = k.point[0] - k.x, k.point[1] - k.y
        front, rear = k.ahead * k.wheelbase, (1.0 - k.ahead) * k.wheelbase
        self.wheel_x = np.stack([front, front, -rear, -rear], axis=1)
        self.wheel_y = np.stack([k.track, -k.track, k.track, -k.track], axis=1) / 2.0
        share = np.stack([rear, rear, front, front], axis=1) / (2.0 * k.wheelbase[:, None])
        self.static = k.mass[:, None] * GRAVITY * share
        # Newtons of load on each wheel for a newton of the tyres' force along and across the car.
        level = k.height[:, None]
        self.by_along = -level / (2.0 * k.wheelbase[:, None]) * np.sign(self.wheel_x)
        self.by_across = -level / (2.0 * k.track[:, None]) * np.sign(self.wheel_y)
        self.brake = k.lock * k.ground * self.static * k.radius[:, None]
        self.steeper = 1.0 / np.maximum(k.restitution, LEAST) ** 2
        # Of the greatest penetration, what is left where the force is 0 again.
        self.kept = 1.0 - 1.0 / self.steeper

    def start(self) -> Any:
        """The state at first touch, after the wheels have run in."""
        k = self.crashes
        state = np.zeros((2, ROWS, k.normal.size))
        for row, value in zip(
            (X, Y, HEADING, VX, VY, YAW_RATE),
            (k.x, k.y, k.heading, k.vx, k.vy, k.yaw_rate),
            strict=True,
        ):
            state[:, row] = value
        along = np.cos(k.heading) * k.vx + np.sin(k.heading) * k.vy
        state[:, SPIN] = (along / k.radius)[:, None]
        if np.any(k.ground > 0.0):
            step = 1e-4
            for _ in range(round(RUN_IN / step)):  # Heun's method on spin and load alone
                rate = np.zeros_like(state)
                self.tyres(state, rate)
                ahead, then = state.copy(), np.zeros_like(state)
                ahead[:, INNER] += step * rate[:, INNER]
                self.tyres(ahead, then)
                state[:, INNER] += 0.5 * step * (rate[:, INNER] + then[:, INNER])
        return state

    def tyres(self, state: Any, rate: Any) -> tuple[Any, Any, Any]:
        """Tyres' force along and across a car and their moment; fills in rates of spin and load."""
        k = self.crashes
        c, s = np.cos(state[:, HEADING]), np.sin(state[:, HEADING])
        vx, vy, yaw = state[:, VX], state[:, VY], state[:, YAW_RATE]
        spin = state[:, SPIN]
        shift_x, shift_y = state[:, None, LAGGING_ALONG], state[:, None, LAGGING_ACROSS]
        rolling = k.radius[:, None] * spin
        slip_x = (c * vx + s * vy)[:, None] - yaw[:, None] * self.wheel_y - rolling
        slip_y = (c * vy - s * vx)[:, None] + yaw[:, None] * self.wheel_x
        size = np.hypot(slip_x, slip_y) + 1e-12
        load = self.static + self.by_along * shift_x + self.by_across * shift_y
        bound = k.ground * np.maximum(load, 0.0)
        steep = k.cornering[:, None] / (3.0 * np.maximum(k.ground, 1e-9))
        u = np.minimum(1.0, steep * size / (np.abs(rolling) + self.slow))
        over = -bound * (u * (3.0 - u * (3.0 - u))) / size
        along, across = over * slip_x, over * slip_y
        held = self.brake * spin / np.sqrt(spin * spin + STILL * STILL)
        rate[:, SPIN] = (-k.radius[:, None] * along - held) / k.spin_inertia[:, None]
        force_x, force_y = along.sum(axis=1), across.sum(axis=1)
        rate[:, LAGGING_ALONG] = (force_x - state[:, LAGGING_ALONG]) / LAG
        rate[:, LAGGING_ACROSS] = (force_y - state[:, LAGGING_ACROSS]) / LAG
        return force_x, force_y, (self.wheel_x * across - self.wheel_y * along).sum(axis=1)

    def place(self, state: Any) -> tuple[Any, ...]:
        """The contact as it lies: normal (x, y), penetration, point (x, y), angle of the normal."""
        turned = state[:, HEADING] - self.crashes.heading
        c, s = np.cos(turned), np.sin(turned)
        px = state[:, X] + c * self.arm_x - s * self.arm_y
        py = state[:, Y] + s * self.arm_x + c * self.arm_y
        angle = self.crashes.normal + 0.5 * (turned[0] + turned[1])
        nx, ny = np.cos(angle), np.sin(angle)
        depth = (px[0] - px[1]) * nx + (py[0] - py[1]) * ny
        return nx, ny, depth, 0.5 * (px[0] + px[1]), 0.5 * (py[0] + py[1]), angle

    def contact(self, state: Any, deepest: Any) -> tuple[Any, ...]:
        """Force along the normal and on A along the tangent, closing speed, slip, and the place."""
        k = self.crashes
        nx, ny, depth, x, y, angle = self.place(state)
        loading = k.stiffness * depth
        unloading = k.stiffness * self.steeper * (depth - self.kept * np.maximum(deepest, depth))
        push = np.maximum(0.0, np.minimum(loading, unloading))
        vx = state[:, VX] - state[:, YAW_RATE] * (y - state[:, Y])
        vy = state[:, VY] + state[:, YAW_RATE] * (x - state[:, X])
        dx, dy = vx[0] - vx[1], vy[0] - vy[1]
        slip = nx * dy - ny * dx
        drag = -k.friction * push * slip / np.sqrt(slip * slip + self.creep * self.creep)
        return push, drag, nx * dx + ny * dy, slip, nx, ny, depth, x, y, angle

    def rate(self, state: Any, deepest: Any, *, touching: bool = True) -> Any:
        """Rate of change of the state, where the contact has been as deep as ``deepest``."""
        k = self.crashes
        rate = np.zeros_like(state)
        if np.any(k.ground > 0.0):
            along, across, moment = self.tyres(state, rate)
            c, s = np.cos(state[:, HEADING]), np.sin(state[:, HEADING])
            tyre_x, tyre_y = c * along - s * across, s * along + c * across
        else:
            tyre_x = tyre_y = moment = np.zeros_like(k.mass)
        force_x, force_y, twist = tyre_x, tyre_y, moment
        if touching:
            push, drag, _, slip, nx, ny, _, x, y, _ = self.contact(state, deepest)
            on_ax, on_ay = -push * nx - drag * ny, -push * ny + drag * nx
            on_x, on_y = np.stack([on_ax, -on_ax]), np.stack([on_ay, -on_ay])
            force_x, force_y = tyre_x + on_x, tyre_y + on_y
            twist = moment + (x - state[:, X]) * on_y - (y - state[:, Y]) * on_x
            rate[0, HEAT] = -drag * slip
        vx, vy, yaw = state[:, VX], state[:, VY], state[:, YAW_RATE]
        ax, ay = force_x / k.mass, force_y / k.mass
        rate[:, X], rate[:, Y], rate[:, HEADING] = vx, vy, yaw
        rate[:, VX], rate[:, VY], rate[:, YAW_RATE] = ax, ay, twist / k.inertia
        c, s = np.cos(state[:, HEADING]), np.sin(state[:, HEADING])
        rate[:, FORWARD], rate[:, LEFT] = c * ax + s * ay, c * ay - s * ax
        rate[:, SQUARED_YAW] = yaw * yaw
        rate[:, TYRE_X], rate[:, TYRE_Y] = tyre_x, tyre_y
        rate[:, TYRE_MOMENT] = moment + state[:, X] * tyre_y - state[:, Y] * tyre_x
        rate[:, TYRE_WORK] = tyre_x * vx + tyre_y * vy + moment * yaw
        return rate

    def energy(self, state: Any) -> Any:
        """Kinetic energy of each car, without that of its wheels."""
        k = self.crashes
        squares = state[:, VX] ** 2 + state[:, VY] ** 2
        return 0.5 * (k.mass * squares + k.inertia * state[:, YAW_RATE] ** 2)


def simulated(crashes: Crashes, *, steps: int = STEPS, creep: float = CREEP) -> Contacts:
    """All crashes at once, first touch to separation, by Runge and Kutta's method of order 4."""
    world = World(crashes, creep=creep)
    before = state = world.start()
    n = crashes.normal.size
    deepest, time, engaged = np.zeros(n), np.zeros(n), np.zeros(n)
    peak, deep = np.zeros(n), state.copy()
    running = np.ones(n, dtype=bool)
    kept = [(time.copy(), state.copy())]
    for count in range(1, round(LONGEST * steps) + 1):
        step = np.where(running, crashes.nominal / steps, 0.0)
        half = 0.5 * step
        k1 = world.rate(state, deepest)
        k2 = world.rate(state + half * k1, deepest)
        k3 = world.rate(state + half * k2, deepest)
        k4 = world.rate(state + step * k3, deepest)
        then = state + step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        push, drag, _, _, _, _, depth, *_ = world.contact(then, deepest)
        peak = np.where(push > 0.0, np.maximum(peak, np.abs(drag) / np.maximum(push, 1e-9)), peak)
        deeper = running & (depth > deepest)
        deep = np.where(deeper, then, deep)
        engaged = np.where(deeper, time + step, engaged)
        # Penetration above that at which the force ends.
        over = depth - world.kept * np.maximum(deepest, depth)
        ends = running & (over <= 0.0)
        if ends.any():
            earlier = world.place(state)[2] - world.kept * deepest
            share = np.where(ends, earlier / np.where(ends, earlier - over, 1.0), 1.0)
            then, step = state + share * (then - state), share * step
        deepest = np.maximum(deepest, np.where(running, depth, 0.0))
        state, time = then, time + step
        running &= ~ends
        if count % EVERY == 0 or not running.any():
            kept.append((time.copy(), state))
        if not running.any():
            break
    return _read(world, before, state, deep, kept, ~running, time, engaged, deepest, peak)


def _read(
    world: World,
    before: Any,
    after: Any,
    deep: Any,
    kept: Any,
    ended: Any,
    time: Any,
    engaged: Any,
    deepest: Any,
    peak: Any,
) -> Contacts:
    crashes = world.crashes
    _, _, _, x, y, normal = world.place(deep)
    own = after - before
    on_x = crashes.mass * own[:, VX] - own[:, TYRE_X]
    on_y = crashes.mass * own[:, VY] - own[:, TYRE_Y]
    nx, ny = np.cos(normal), np.sin(normal)
    _, _, _, slip, *_ = world.contact(after, deepest)
    moments = np.stack([moment for moment, _ in kept])
    curves = np.stack([state for _, state in kept])
    return Contacts(
        ended=ended,
        duration=time,
        penetration=deepest,
        slip=slip,
        ratio=(nx * on_y[1] - ny * on_x[1]) / (nx * on_x[1] + ny * on_y[1]),
        peak_ratio=peak,
        engaged=engaged,
        x=deep[:, X],
        y=deep[:, Y],
        heading=deep[:, HEADING],
        point=np.stack([x, y]),
        normal=normal,
        after=after,
        impulse=np.stack([on_x, on_y], axis=1),
        time=moments,
        recorded_forward=curves[:, :, FORWARD],
        recorded_left=curves[:, :, LEFT],
        turned=curves[:, :, YAW_RATE] - before[:, YAW_RATE],
        squared_yaw=curves[:, :, SQUARED_YAW],
        energy_before=world.energy(before),
        energy_after=world.energy(after),
        lost_along=0.5 * crashes.stiffness * deepest**2 * world.kept,
        heat=after[0, HEAT],
        tyre_work=own[:, TYRE_WORK],
    )


def rests(crashes: Crashes, contacts: Contacts, *, longest: float = 10.0) -> tuple[Any, Any]:
    """Where each car comes to rest, (2, 3, crashes): x, y and heading, and when after separation.

    NaN of a car that still moves after ``longest`` [s], as one whose wheels roll does.
    """
    world = World(crashes, slow=OUT_OF_CONTACT)
    load = crashes.mass * GRAVITY / 2.0  # of a wheel, at most, with what is shifted to it
    stiff = crashes.radius**2 * crashes.cornering * load / (crashes.spin_inertia * OUT_OF_CONTACT)
    step = 2.0 / float(stiff.max())  # the method is stable up to 2.8
    state, none = contacts.after.copy(), np.zeros(crashes.normal.size)
    found, when = np.full((2, 3, none.size), np.nan), np.full((2, none.size), np.nan)
    for count in range(1, round(longest / step) + 1):
        k1 = world.rate(state, none, touching=False)
        k2 = world.rate(state + 0.5 * step * k1, none, touching=False)
        k3 = world.rate(state + 0.5 * step * k2, none, touching=False)
        k4 = world.rate(state + step * k3, none, touching=False)
        state = state + step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        still = world.energy(state) < 0.5 * crashes.mass * RESTING**2
        new = still & np.isnan(when)
        found = np.where(new[:, None], state[:, :3], found)
        when = np.where(new, count * step, when)
        if not np.isnan(when).any():
            break
    return found, when


def by_scipy(crashes: Crashes, i: int, *, creep: float = CREEP) -> tuple[float, Any]:
    """Duration and state after of one crash by scipy: loading, then unloading, with events."""
    from scipy.integrate import solve_ivp

    world = World(crashes.take([i]), creep=creep)
    shape = (2, ROWS, 1)
    start = world.start()
    settings: dict[str, Any] = {"method": "LSODA", "rtol": 1e-8, "atol": 1e-8}

    def turns(_: float, flat: Any) -> float:
        return float(world.contact(flat.reshape(shape), np.zeros(1))[2][0])

    turns.terminal, turns.direction = True, -1.0

    def rises(_: float, flat: Any) -> Any:
        return world.rate(flat.reshape(shape), np.zeros(1)).ravel()

    longest = LONGEST * float(world.crashes.nominal[0])
    first = solve_ivp(rises, (0.0, longest), start.ravel(), events=turns, **settings)
    deepest = world.place(first.y[:, -1].reshape(shape))[2]

    def ends(_: float, flat: Any) -> float:
        return float((world.place(flat.reshape(shape))[2] - world.kept * deepest)[0])

    ends.terminal, ends.direction = True, -1.0

    def falls(_: float, flat: Any) -> Any:
        return world.rate(flat.reshape(shape), deepest).ravel()

    last = solve_ivp(falls, (first.t[-1], longest), first.y[:, -1], events=ends, **settings)
    return float(last.t[-1]), last.y[:, -1].reshape(shape)[..., 0]
