"""Where every file goes. Paths are relative to src/collisions (FILES) and to tests (TESTS)."""

# Old file -> new file. Files that are not named stay where they are; a new file of the flat root that is not named is reported.
FILES = {
    "kernels/tracing.py": "engine/tracing.py",
    "kernels/floats.py": "engine/floats.py",
    "kernels/javascript.py": "engine/javascript.py",
    "kernels/replay.py": "engine/replay.py",
    "kernels/buffers.py": "engine/buffers.py",
    "kernels/batch.py": "engine/batch.py",
    "errors.py": "messages/errors.py",
    "hints.py": "messages/hints.py",
    "warning.py": "messages/warning.py",
    "progress.py": "messages/progress.py",
    "units.py": "quantities/units.py",
    "settings.py": "quantities/settings.py",
    "reading.py": "quantities/reading.py",
    "directions.py": "quantities/directions.py",
    "quantities.py": "quantities/attributes.py",
    "quantity_names.py": "quantities/attribute_stubs.py",
    "formatting.py": "quantities/formatting.py",
    "summary.py": "quantities/tables.py",
    "document.py": "quantities/document.py",
    "vehicle.py": "vehicle/vehicle.py",
    "outlines.py": "vehicle/outlines.py",
    "drag.py": "vehicle/drag.py",
    "tyres.py": "vehicle/tyres.py",
    "inputs.py": "impact/inputs.py",
    "models.py": "impact/models.py",
    "contact_time.py": "impact/time_resolved_inputs.py",
    "solving.py": "impact/run.py",
    "model_choice.py": "impact/choice.py",
    "side.py": "impact/side.py",
    "impact.py": "impact/impact.py",
    "pulse.py": "impact/pulse.py",
    "provenance.py": "impact/provenance.py",
    "records.py": "impact/records.py",
    "schema.py": "impact/schema.py",
    "solvers.py": "impact/solvers.py",
    "contact_effects.py": "impact/left_out.py",
    "during_contact.py": "impact/during_contact.py",
    "case_file.py": "cases/read.py",
    "case_words.py": "cases/words.py",
    "case_answers.py": "cases/answers.py",
    "case_schema.py": "cases/schema.py",
    "case_template.toml": "cases/case_template.toml",
    "case_template_us.toml": "cases/case_template_us.toml",
    "what_if_page.py": "reporting/what_if.py",
    "what_if_page.html": "reporting/what_if.html",
    "reconstruct/fit.py": "estimate/fit.py",
    "reconstruct/fit_result.py": "estimate/fit_result.py",
    "reconstruct/least_squares.py": "estimate/least_squares.py",
    "reconstruct/bayes.py": "estimate/posterior.py",
    "reconstruct/posterior_result.py": "estimate/posterior_result.py",
    "reconstruct/islands.py": "estimate/islands.py",
    "reconstruct/observations.py": "estimate/evidence.py",
    "reconstruct/comparison.py": "estimate/compare.py",
    "reconstruct/observed.py": "reconstruct/from_motions.py",
    "reconstruct/recorded.py": "reconstruct/recorder.py",
    "uncertainty/angles.py": "uncertainty/turns.py",
}

# New files taken out of one of the moved ones: source (old path) -> new file -> its docstring, and the names that go there.
SPLITS = {
    "kernels/batch.py": {
        "quantities/precision.py": (
            "``precision``: whether the numbers of a call are worked out in float32 or float64.",
            ("precision", "_TINY", "_HUGE"),
        ),
        "engine/blocks.py": (
            "Blocks of a batch: how long they are, and work on them in order, on one thread or several.",
            ("BLOCK", "_SCRATCH", "_LONGEST", "_CACHE", "Progress", "T", "R", "block_length", "each_block", "in_order", "flat"),
        ),
    },
    "records.py": {
        "quantities/strict_json.py": ("``strict``: values as strict JSON.", ("strict",)),
    },
}

# Files merged into another, which imports them: old path -> old path of the other. (Why the others of house_moves.json are not:
# NOT_MERGED.)
MERGES = {
    "during_contact.py": "contact_effects.py",
}
NOT_MERGED = {
    "plot/ticks.py": "its class derives from one of matplotlib, which is imported when something is drawn; canvas.py is imported before",
    "kernels/buffers.py": "each printer of the tape stays under a hundred lines, which test_printers promises; memory is another matter",
    "quantity_names.py": "lists for editors and type checkers alone, which a test compares; nothing at run time reads them",
    "document.py": "a page of text that saves itself, and a table: two things, and derivation and reporting use only the first",
    "settings.py": "units.py (486 lines) is the only file that names pint and imports errors alone; settings would tie it to hints",
    "case_words.py": "read.py has 499 lines already, and errors that carry their parts (section 2.7) will take most of words.py out",
    "reconstruct/momentum_solution.py": "a result beside its solver, as fit_result, posterior_result and the run-out are",
}

# The first line of each new room.
DOCSTRINGS = {
    "engine": "What makes the formulas quick: they are recorded once, and run as blocks of a batch, as plain floats, or as JavaScript.",
    "messages": "What a caller is told: errors, hints at what to write, warnings and progress.",
    "quantities": "Numbers with units: read from what a caller gives, and shown as attributes, texts, tables and JSON.",
    "vehicle": "The vehicle, its outline, and the drag of its tyres.",
    "impact": "The impact: its inputs, the solvers, and the answer with everything that is worked out from it.",
    "estimate": "Evidence weighed: the most likely inputs, their posterior distribution, and accounts compared.",
    "cases": "Case files: read, answered and described by a schema.",
}

# Tests by room, without "test_" and ".py"; "old>new" where the name of the room need not be said twice.
TESTS = {
    "kernels": "added_entries contact_passage elsewhere identities reference reference_in_time",
    "engine": "batch flat printers tracing",
    "messages": "hints progress quiet",
    "quantities": "require_units summary>tables unit_systems units",
    "vehicle": "vehicle",
    "impact": "idealisation>left_out impact outside paper properties refusals refused_cases scene>choice time_resolved tools",
    "travel": "path_survey simulate travel",
    "uncertainty": (
        "uncertainty_answers>answers uncertainty_elementwise>elementwise uncertainty_fuzz>fuzz_propagate uncertainty_inputs>inputs "
        "uncertainty_intervals>intervals uncertainty_local>local uncertainty_points>points uncertainty_sampling>sampling"
    ),
    "reconstruct": (
        "planar_refusals reconstruct_central>central reconstruct_components>speeds_components reconstruct_momentum>momentum "
        "reconstruct_observed>from_motions reconstruct_planar>planar reconstruct_speeds>speeds recorded_pulse>recorder"
    ),
    "estimate": "reconstruct_compare>compare reconstruct_fit>fit reconstruct_posterior>posterior",
    "diagnostics": "diagnostics thresholds",
    "derivation": "derivation",
    "reporting": "reporting what_if",
    "plot": "plot",
    "reference": "reference_values",
    "cases": "case_file fuzz_cases",
    "docs": (
        "architecture design docs evidence_page examples posterior_page published speed_page stability_page uncertainty_page validation"
    ),
    "project": "coverage_corners extending fuzz fuzz_backwards fuzz_names package wheel",
}
# Tests that are new: the first pattern that is found in the name decides; else "project", which is reported.
NEW_TESTS = (
    ("_page$|docs", "docs"), ("fuzz", "project"), ("tyre|simulate|run_out|survey|travel|areas", "travel"), ("uncertain", "uncertainty"),
    ("posterior|fit|compare|stud", "estimate"), ("recorder|reconstruct|speeds|planar|momentum", "reconstruct"),
    ("kernel|law|contact_step", "kernels"), ("explain|derivation", "derivation"), ("report|what_if", "reporting"), ("plot", "plot"),
    ("case", "cases"), ("vehicle|outline", "vehicle"), ("unit|summary|reading", "quantities"), ("batch|tracing", "engine"),
    ("error|hint|warning|progress", "messages"), ("diagnos|finding", "diagnostics"), ("reference", "reference"),
    ("impact|contact|solve|record|left_out|time_resolved", "impact"),
)
