#!/usr/bin/env python3
"""Searches the price of a step and a search's budget of evaluations: see README.md beside it."""
import argparse
import json
import math
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SEARCHED_ON = ["trianglemesh", "both", "concentric", "clumped"]
HELD_OUT = ["aisles-2", "drift-2", "stadium-2", "sticks-2", "sizes-2", "terrain"]
DEFAULTS = {"step": 6.0, "evaluations": 100}
FRAME_PIXELS = 1920 * 1080


class Objective:
    """The geometric mean over scenes of build and one frame, in units of the defaults'. A frame is
    counted work, so that a busy machine decides little; builds are the least of three."""

    def __init__(self, arguments, scenes):
        self.arguments = arguments
        self.scenes = scenes
        self.base = {scene: self.seconds(scene, DEFAULTS) for scene in scenes}

    def seconds(self, scene, point):
        a = self.arguments
        command = [a.program, f"--file={a.scenes / scene}.x3d", f"--methods={a.method}",
                   "--in-program", f"--step={point['step']}",
                   f"--evaluations={point['evaluations']}", "--res=160,90", "--rays=0",
                   "--rounds=3"]
        run = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
        row = run["rows"][0]
        work = a.test_ns * row["camera"]["tests"] + a.leaf_ns * row["camera"]["leaves"]
        return (min(row["build_seconds"]), 1e-9 * work * FRAME_PIXELS / run["pixels"])

    def __call__(self, point):
        logs = []
        for scene in self.scenes:
            found, base = self.seconds(scene, point), self.base[scene]
            logs.append(math.log(sum(found) / sum(base)))
        return math.exp(sum(logs) / len(logs))


def search_by_optuna(objective, arguments, tuned):
    import optuna
    from optuna.storages import JournalStorage
    from optuna.storages.journal import JournalFileBackend
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    study = optuna.create_study(
        study_name=arguments.method, load_if_exists=True,
        storage=JournalStorage(JournalFileBackend(str(arguments.journal))),
        sampler=optuna.samplers.TPESampler(seed=1))

    def ask(trial):
        point = dict(DEFAULTS, step=trial.suggest_float("step", 1, 24, log=True))
        if tuned:
            point["evaluations"] = trial.suggest_int("evaluations", 5, 400, log=True)
        return objective(point)

    study.optimize(ask, n_trials=arguments.trials)
    return dict(DEFAULTS, **study.best_params), study.best_value


def search_by_skopt(objective, arguments, tuned):
    import skopt
    from skopt.space import Integer, Real
    space = [Real(1, 24, prior="log-uniform", name="step")]
    if tuned:
        space.append(Integer(5, 400, prior="log-uniform", name="evaluations"))

    def point_of(x):
        return dict(DEFAULTS, **{dim.name: v.item() if hasattr(v, "item") else v
                                 for dim, v in zip(space, x)})

    found = skopt.gp_minimize(lambda x: objective(point_of(x)), space,
                              n_calls=arguments.trials, random_state=1)
    history = [{"point": point_of(x), "value": float(v)}
               for x, v in zip(found.x_iters, found.func_vals)]
    arguments.journal.with_suffix(".skopt.json").write_text(json.dumps(history, indent=1))
    return point_of(found.x), float(found.fun)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(ROOT / "build/study/study/nuvo_study"))
    parser.add_argument("--scenes", type=Path, default=ROOT / "results/midpoints/scenes")
    parser.add_argument("--journal", type=Path, default=ROOT / "results/tune/journal.log")
    parser.add_argument("--method", default="sweep")
    parser.add_argument("--sampler", choices=["optuna", "skopt"], default="optuna")
    parser.add_argument("--trials", type=int, default=30)
    # What scripts/study_midpoints.sh says at its end.
    parser.add_argument("--test-ns", type=float, default=8)
    parser.add_argument("--leaf-ns", type=float, default=40)
    arguments = parser.parse_args()
    arguments.journal.parent.mkdir(parents=True, exist_ok=True)
    tuned = arguments.method.startswith(("mlsl", "isres", "auglag"))
    search = search_by_optuna if arguments.sampler == "optuna" else search_by_skopt
    best, value = search(Objective(arguments, SEARCHED_ON), arguments, tuned)
    held_out = Objective(arguments, HELD_OUT)
    print(json.dumps({"method": arguments.method, "sampler": arguments.sampler,
                      "trials": arguments.trials, "best": best, "searched_on": value,
                      "held_out": held_out(best), "defaults_again": held_out(DEFAULTS)}))


if __name__ == "__main__":
    main()
