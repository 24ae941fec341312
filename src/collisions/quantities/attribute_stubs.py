"""What ``.q`` of each result has, by name, for editors and type checkers; a test compares the lists
with the results.
"""

from __future__ import annotations

from typing import Any

# A pint Quantity, whose own types leave too much open for type checkers.
_QUANTITY: Any = None


class VehicleQuantities:
    """Those of ``Vehicle``."""

    course = given = heading = kinetic_energy = mass = momentum = name = pivot = point = speed = (
        _QUANTITY
    )
    velocity_at = vx = vy = x = y = yaw_inertia = yaw_rate = _QUANTITY


class VehicleResultQuantities:
    """Those of ``VehicleResult``."""

    before: VehicleQuantities
    after: VehicleQuantities
    at_compression: VehicleQuantities
    delta_v = delta_v_at = delta_v_forward = delta_v_left = delta_vx = delta_vy = delta_yaw_rate = (
        gamma
    ) = _QUANTITY
    impulse_direction = impulse_x = impulse_y = kinetic_energy_change = moment_arm = normal_arm = (
        pdof
    ) = _QUANTITY
    pdof_clock = pivot_impulse_x = pivot_impulse_y = tyre_impulse_x = tyre_impulse_y = tyre_loss = (
        tyre_moment
    ) = _QUANTITY
    outside_x = outside_y = outside_yaw = outside_work = recorded = _QUANTITY


class ImpactQuantities:
    """Those of ``Impact``."""

    a: VehicleResultQuantities
    b: VehicleResultQuantities
    choice = closing_speed = common_velocity = complete = compression_impulse = (
        critical_impulse_ratio
    ) = ees = _QUANTITY
    effective_mass = energy_absorbed = energy_loss = energy_loss_normal = energy_loss_tangential = (
        _QUANTITY
    )
    found = speed_a = speed_b = _QUANTITY
    friction = impulse_ratio = kind = law = max_crush_speeds = model = momentum_residual = (
        normal
    ) = _QUANTITY
    normal_angle = normal_impulse = ok = point = pulse = reconstruction = refused = regime = (
        _QUANTITY
    )
    relative_speed = restitution = restitution_impulse = separation_speed = slip_after = (
        slip_before
    ) = _QUANTITY
    statements = status = tangential_impulse = _QUANTITY


class MomentumSolutionQuantities:
    """Those of ``MomentumSolution``."""

    closing_speed = condition = course_a = course_a_after = course_b = course_b_after = (
        course_near
    ) = delta_v_a = delta_v_b = duration = given = heading_a = heading_b = _QUANTITY
    found = mass_a = mass_b = normal_angle = ok = outside_impulse_x = outside_impulse_y = pdof_a = (
        pdof_b
    ) = restitution = sensitivity = speed_a = speed_a_after = _QUANTITY
    speed_b = speed_b_after = statements = status = translational_energy_loss = tyre_impulse_x_a = (
        tyre_impulse_x_b
    ) = tyre_impulse_y_a = tyre_impulse_y_b = tyres = tyres_a = tyres_b = unknowns = _QUANTITY
    yaw_rate_a_after = yaw_rate_b_after = _QUANTITY


class RunOutQuantities:
    """Those of ``RunOut``."""

    course = course_difference = course_error = crab_angles = distance = drags = speed = (
        speed_error
    ) = _QUANTITY
    speeds = straight_course = time = yaw_rate = yaw_rate_error = _QUANTITY


class TyresQuantities:
    """Those of ``Tyres``."""

    cornering = friction = height = lock = locks = named = steer = steered = track = transfers = (
        wheelbase
    ) = _QUANTITY
