"""Tables of README.md."""
from results_tables import NONE, markdown, span, with_count
from .declare import Step, add, printed, transcript


add(name="street_short", file="README.md", seeds="1", minutes=0.1,
    steps=[Step("run", ["build/patrol", "run", "street/short", "--out", "{out}"])],
    values=printed("run", "out/short"), text=transcript)


def worst_docking(runs):
    """Largest docking error; runs that did not dock have none."""
    errors = [run["metrics"]["docking.position_error_m.max"] for run in runs if "docking.position_error_m.max" in run["metrics"]]
    return with_count(f"at most {1000 * max(errors):.1f} mm", len(errors), len(runs)) if errors else NONE


def summary_values(tables):
    patrol, navigation = tables["street_patrol"]["patrol"], tables["tunnel_navigation"]["navigation"]
    scenarios, inspection = tables["tunnel_scenarios"], tables["tunnel_inspection"]["inspection"]
    goals = [span(navigation, f"goals.goal_{i}.position_error_m.mean", ".3f", " m") for i in (1, 2, 3)]
    return {"patrol": span(patrol, "pose.site.ate_rmse_m", ".3f", " m"), "goals": "; ".join(goals), "docking": worst_docking(scenarios["docking"]),
            "lining": span(inspection, "inspection.lining.max_error_mm", ".2f", " mm"), "patrol_seeds": len(patrol),
            "navigation_seeds": len(navigation), "docking_seeds": len(scenarios["docking"]), "lining_seeds": len(inspection),
            "log": next(row["error"] for row in tables["slam_logs"] if row["log"] == "intel" and row["method"] == "graph"),
            "substation": next(row["mean"] for row in tables["study_substation"]
                               if row["figure"] == "map to nearest surface" and "graph" in row["method"])}


def summary_text(values):
    return markdown(["result", "value", "seeds"], [
        ["[street patrol](worlds/street/README.md), quadruped, 194 m: position error in the survey frame", values["patrol"], values["patrol_seeds"]],
        ["[tunnel navigation](worlds/tunnel/README.md), tracked robot: mean errors at goals 1, 2 and 3", values["goals"],
         values["navigation_seeds"]],
        ["[tunnel docking](worlds/tunnel/README.md)", values["docking"], values["docking_seeds"]],
        ["[lining deformation](worlds/tunnel/README.md#inspection) of 3, 6 and 12 mm: maximum error", values["lining"],
         values["lining_seeds"]],
        ["[recorded log](src/slam/README.md), Intel Research Lab: mean relation error", values["log"], NONE],
        ["[substation map](src/app/study/README.md), 923 m: distance to the nearest surface", f"{float(values['substation']):.3f} m", 5]])


add(name="summary", file="README.md", seeds="those of the linked tables", minutes=0, steps=[],
    needs=("street_patrol", "tunnel_navigation", "tunnel_scenarios", "tunnel_inspection", "slam_logs", "study_substation"),
    values=summary_values, text=summary_text)
