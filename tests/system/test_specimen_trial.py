"""Specimens that earlier programs did not serve (docs/decisions/engine-and-twins.md has the list), tried by specimen_trial.py on a CAN bus of processes."""
import types
import unittest.mock

import harness
import specimen_trial

# 19 samples its control word each 6 ms. 22 has no position demand. 53 shows a mode after 468 ms and takes a mapping in pre-operational only; nothing
# takes it there when its master is gone. 57 is stopped by another master while it turns. 43 refuses another mode under a halt.
SEEDS = ("19", "22", "43", "53", "57")


@harness.alone
def test_drives_that_earlier_programs_did_not_serve():
    plan = types.SimpleNamespace(program=harness.PROGRAM, twins=harness.PROGRAM, can=None, watches=False, most=3, once=False)
    results = list(specimen_trial.tried(plan, [(seed, seed, {}) for seed in SEEDS], 2))
    assert len(results) == len(SEEDS) and all(not failures for _, _, failures in results), results


def test_the_trial_tells_a_drive_that_is_not_found():
    plan = types.SimpleNamespace(program=harness.PROGRAM, twins=harness.PROGRAM, can=None, watches=False, most=3)
    of_bench = specimen_trial.Bench.site

    def with_another_node(bench, patience):
        site = of_bench(bench, patience)
        site["drives"][0]["address"] = 6
        return site
    with unittest.mock.patch.object(specimen_trial, "FIND_S", 3), unittest.mock.patch.object(specimen_trial.Bench, "site", with_another_node):
        _, _, failures = specimen_trial.play(plan, "0", "0", {})
    assert len(failures) == 1 and failures[0][0] == "find" and "does not answer" in failures[0][1], failures
