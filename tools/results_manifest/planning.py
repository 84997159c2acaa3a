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


def driven_text(values):
    def mean(runs, method, path):
        found = [run["metrics"][path] for run in runs if run["variant"].endswith(f"={method}") or run["variant"] == method]
        return sum(found) / len(found)
    rows = []
    for method, title in METHODS.items():
        row = [title]
        for key in ("tunnel", "street"):
            cells = [mean(values[key], method, path) for path in DRIVEN]
            row += [f"{cells[0]:.0f}", f"{cells[1]:.1f}", f"{cells[2]:.1f}", f"{cells[3]:.2f}, {cells[4]:.2f}"]
        rows.append(row)
    return markdown(["", "tunnel: s", "m", "detours", "clearance, m: mean, 5 % quantile", "street: s", "m", "detours", "clearance, m"], rows)


add(name="planners_in_the_loop", file="src/plan/README.md", seeds=REPORT_FIVE, minutes=25,
    steps=[sweep(key, f"{key}/scenarios/{scenario}", REPORT_FIVE, "--vary",
                 "stack.navigation.global_planner.method=" + ",".join(METHODS)) for key, scenario in (("tunnel", "navigate"), ("street", "patrol"))],
    values=swept(tunnel=DRIVEN, street=DRIVEN), text=driven_text)
