"""Outputs of commands in the tutorials, and the commands of the documents that take minutes."""
import json

from results_tables import markdown
from .declare import Step, add, printed, transcript

add(name="tutorial_run", file="src/app/tutorials/first_what_if.md", seeds="1", minutes=0.1,
    steps=[Step("run", ["build/patrol", "run", "street/short", "--out", "{out}"])],
    values=printed("run", "out/what_if/run"), text=transcript)

add(name="tutorial_sweep", file="src/app/tutorials/first_what_if.md", seeds="1 to 3", minutes=0.5,
    steps=[Step("sweep", ["build/patrol", "sweep", "street/short", "--vary", "sensors.lidar.range_noise_std_m=0.015,0.1", "--seeds", "3",
                          "--metric", "map.nearest_mean_m", "--metric", "pose.aligned.rmse_m", "--out", "{out}"])],
    values=printed("sweep", "out/what_if/sweep"), text=transcript)


def long_values(folders):
    return [{"document": row["document"], "commands": [f"patrol {call[0]}" for call in row["commands"]], "code": row["code"], "minutes": round(row["minutes"], 1)}
            for row in json.loads((folders["long"] / "long.json").read_text())]


def long_text(rows):
    return markdown(["document", "commands", "exit code", "minutes on two cores"],
                    [[f"[{row['document']}](../{row['document']})", ", ".join(f"`{command}`" for command in dict.fromkeys(row["commands"])), row["code"], row["minutes"]]
                     for row in rows])


add(name="long_commands", file="tests/README.md", seeds="those of the commands", minutes=60, files=("tests/core/document_commands_test.py",),
    steps=[Step("long", ["sh", "-c", "mkdir -p {out} && python3 tests/core/document_commands_test.py build/patrol . --run-long {out}/long.json"])],
    values=long_values, text=long_text)
