"""What each miss was found to be, from what the measurements say of themselves
(``measured.self_check``).

An input is never changed by it. The figures named here are those of the page's table of that check,
or of the sources.
"""

GEOMETRY, TYRES, SIDE_SLAP, MEASUREMENT = "geometry", "tyres", "side slap", "the measurement"
OBSTACLE = "an obstacle"

_NO_TYRES = "the contact in time, whose tyres take energy, holds it"
_COUPLE = (
    "the cars left with one yaw rate: a contact as wide as the damage passes on a couple, which "
    "a point cannot"
)
_UNCLOSED = (
    "A lost a third more momentum than B gained; no impulse gives both, and their mean is held"
)
_NOT_ONE_POINT = (
    "at the drawn point the cars would still approach after the impact; A asks for an impulse "
    "0.87 m nearer to its centre of mass, B for one 0.22 m further from its own, which no one "
    "point gives"
)
_SILLS = "read at the door sills, in axes that turned with the car: no better than this"
_SIDE_SLAP = "the cars struck a second time, side against side; no single contact gives both"

CAUSES: dict[tuple[str, str], tuple[str, str]] = {
    ("ricsac_01", "energy_lost"): (TYRES, _NO_TYRES),
    ("ricsac_03", "delta_v_b"): (
        GEOMETRY,
        (
            "the impulse passed 0.12 m from the centre of mass of B, not 0.55 m as drawn, so "
            "more of its mass was struck; the cars also sprang back more than the middle of the "
            "range"
        ),
    ),
    ("ricsac_03", "yaw_rate_a"): (GEOMETRY, _COUPLE),
    ("ricsac_03", "yaw_rate_b"): (GEOMETRY, _COUPLE),
    ("ricsac_03", "energy_lost"): (
        TYRES,
        (
            "the cars rolled, by their places of rest with a drag of 0.04 to 0.05: the range of "
            "the wheels, to locked, has too much braking in it"
        ),
    ),
    ("ricsac_04", "delta_v_a"): (MEASUREMENT, _UNCLOSED),
    ("ricsac_04", "delta_v_b"): (MEASUREMENT, _UNCLOSED),
    ("ricsac_04", "energy_lost"): (
        MEASUREMENT,
        (
            "both cars together lost 4,500 N s, 1.25 g for 0.1 s: more than tyres can take in "
            "that time, so read later than the end of the contact, or wrongly"
        ),
    ),
    ("ricsac_05", "energy_lost"): (TYRES, _NO_TYRES),
    ("ricsac_06", "delta_v_a"): (GEOMETRY, _NOT_ONE_POINT),
    ("ricsac_06", "delta_v_b"): (GEOMETRY, _NOT_ONE_POINT),
    ("ricsac_06", "energy_lost"): (TYRES, _NO_TYRES),
    ("ricsac_10", "delta_v_a"): (
        SIDE_SLAP,
        f"{_SIDE_SLAP}; the sensor of A is not corrected, and momentum misses by a third",
    ),
    ("ricsac_10", "delta_v_b"): (SIDE_SLAP, f"{_SIDE_SLAP}; momentum misses by a third"),
    ("ricsac_10", "yaw_rate_b"): (SIDE_SLAP, _SIDE_SLAP),
    ("ricsac_10", "energy_lost"): (
        SIDE_SLAP,
        f"{_SIDE_SLAP}; one of the printed velocities is wrong besides",
    ),
    ("ricsac_12", "yaw_rate_a"): (
        GEOMETRY,
        (
            "the impulse passed 0.13 m further from the centre of mass of A than drawn, and 0.21 "
            "m from that of B, on its other side"
        ),
    ),
    ("nhtsa_7292", "delta_v_left_a"): (
        MEASUREMENT,
        "read at the door sills in axes that turned with the car, 1 percent outside",
    ),
    ("nhtsa_7292", "delta_v_left_b"): (
        MEASUREMENT,
        "read at the door sills in axes that turned with the car, 4 percent outside",
    ),
}

BACKWARDS: dict[tuple[str, str], tuple[str, str]] = {
    ("RICSAC 1", "momentum"): (
        TYRES,
        "a fifth of the impulse is not between the cars: the tyres', or the measurement's",
    ),
    ("RICSAC 4", "delta-V of A"): (
        MEASUREMENT,
        "A lost a third more momentum than B gained: the truth lies between both answers",
    ),
    ("RICSAC 4", "delta-V of B"): (
        MEASUREMENT,
        "A lost a third more momentum than B gained: the truth lies between both answers",
    ),
    ("RICSAC 6", "delta-V of B"): (GEOMETRY, _NOT_ONE_POINT),
    ("RICSAC 10", "momentum"): (SIDE_SLAP, f"{_SIDE_SLAP}; momentum misses by a third"),
    ("RICSAC 10", "delta-V of A"): (SIDE_SLAP, f"{_SIDE_SLAP}; its delta-V is that of both blows"),
    ("RICSAC 3", "places of rest"): (
        TYRES,
        (
            "both cars rolled, with a drag of 0.04 to 0.05; where any drag up to 0.8 is as likely, "
            "so little is taken for improbable. The answer says that its evidence agrees only "
            "weakly with itself"
        ),
    ),
    ("RICSAC 3", "places of rest and both delta-V"): (
        TYRES,
        (
            "1 percent outside: the delta-Vs draw the speed back from what the long ways ask for, "
            "not all the way. The answer warns that its evidence contradicts itself"
        ),
    ),
    ("RICSAC 6", "places of rest and both delta-V"): (GEOMETRY, _NOT_ONE_POINT),
    ("RICSAC 10", "places of rest"): (SIDE_SLAP, _SIDE_SLAP),
    ("RICSAC 10", "places of rest and both delta-V"): (SIDE_SLAP, _SIDE_SLAP),
}
"""The same for what is worked out backwards, by test and route."""

_OTHER_SENSE = (
    "the printed places lie on the other side of the course than the measured velocities after, "
    "and the printed turns are against the measured yaw rates: of this test the sense is probably "
    "the other one; turned, A is held, and B misses by 0.2 m"
)

AT_REST: dict[tuple[str, str], tuple[str, str]] = {
    ("ricsac_03", "rest_left_a"): (MEASUREMENT, _OTHER_SENSE),
    ("ricsac_03", "rest_left_b"): (MEASUREMENT, _OTHER_SENSE),
    ("ricsac_10", "rest_forward_a"): (SIDE_SLAP, _SIDE_SLAP),
    ("ricsac_10", "rest_forward_b"): (
        OBSTACLE,
        (
            "a transformer box stopped B after a second blow of A; it left the first at 4.4 m/s "
            "forward and is said to lie 2.6 m behind where it was struck"
        ),
    ),
}
"""The same for places of rest."""
