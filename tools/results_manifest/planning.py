"""Tables of the planners."""
import json

from results_tables import markdown
from .declare import REPORT_FIVE, Step, add, sweep, swept

PLANNERS = {"theta_star": "Theta*", "astar": "A*", "dijkstra": "Dijkstra"}


def plan_values(folders):
    kept = {}
    for key in PLANNERS:
        plan = json.loads((folders[key] / "plan.json").read_text())
        kept[key] = {"length_m": plan["route"]["length_m"], "turns": plan["route"]["turns"],
                     "expanded_cells": plan["route"]["expanded_cells"], "gap_to_any_angle": plan["references"]["gap_to_any_angle"]}
    return kept


def plan_text(values):
    return markdown(["planner", "length, m", "turns", "above the any-angle optimum", "expanded cells"],
                    [[title, f"{values[key]['length_m']:.2f}", values[key]["turns"],
                      f"{values[key]['gap_to_any_angle']:.2%}", values[key]["expanded_cells"]]
                     for key, title in PLANNERS.items()])


add(name="plan_tunnel", file="src/plan/README.md", seeds="none (no random draw)", minutes=0.2,
    steps=[Step(key, ["build/patrol", "plan", "worlds/tunnel/map/map.yaml", "--from", "0,0", "--to", "-109.35,-5.75", "--robot", "tracked",
                      "--planner", key, "--out", "{out}"], (0,)) for key in PLANNERS],
    values=plan_values, text=plan_text)

METHODS = {"theta_star": "**Theta\\***", "astar": "A*", "dijkstra": "Dijkstra", "ant_colony_li22": "ant colony, improved",
           "ant_system": "ant system", "dual_swarm_pso": "dual swarm"}
DRIVEN = ("mission.duration_s", "mission.distance_m", "navigation.detours", "navigation.clearance.mean_m", "navigation.clearance.p05_m")


def driven_cells(runs):
    """Means of the runs without a fall, and the number of the others."""
    whole = [run["metrics"] for run in runs if not run["metrics"]["mission.fell"]]
    duration, distance, detours, mean, low = (sum(metrics[path] for metrics in whole) / len(whole) for path in DRIVEN)
    fell = f"; {len(runs) - len(whole)} of {len(runs)} fell" if len(whole) < len(runs) else ""
    return [f"{duration:.0f}{fell}", f"{distance:.1f}", f"{detours:.1f}", f"{mean:.2f}, {low:.2f}"]


def driven_text(values):
    rows = [[title] + [cell for key in ("tunnel", "street") for cell in
                       driven_cells([run for run in values[key] if run["variant"].endswith(f"={method}") or run["variant"] == method])]
            for method, title in METHODS.items()]
    return markdown(["", "tunnel: s", "m", "detours", "clearance, m: mean, 5 % quantile", "street: s", "m", "detours", "clearance, m"], rows)


add(name="planners_in_the_loop", file="src/plan/README.md", seeds=REPORT_FIVE, minutes=25,
    steps=[sweep(key, f"{key}/scenarios/{scenario}", REPORT_FIVE, "--vary",
                 "stack.navigation.global_planner.method=" + ",".join(METHODS)) for key, scenario in (("tunnel", "navigate"), ("street", "patrol"))],
    values=swept(tunnel=(*DRIVEN, "mission.fell"), street=(*DRIVEN, "mission.fell")), text=driven_text)
