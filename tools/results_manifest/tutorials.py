"""Outputs of commands in the tutorials."""
from .declare import Step, add, printed, transcript

add(name="tutorial_run", file="src/app/tutorials/first_what_if.md", seeds="1", minutes=0.0, needs=("street_short",), steps=[],
    values=lambda tables: [line.replace("out/short", "out/what_if/run") for line in tables["street_short"]], text=transcript)

add(name="tutorial_sweep", file="src/app/tutorials/first_what_if.md", seeds="1 to 3", minutes=0.5,
    steps=[Step("sweep", ["build/patrol", "sweep", "street/short", "--vary", "sensors.lidar.range_noise_std_m=0.015,0.1", "--seeds", "3",
                          "--metric", "map.nearest_mean_m", "--metric", "pose.aligned.rmse_m", "--out", "{out}"])],
    values=printed("sweep", "out/what_if/sweep"), text=transcript)
