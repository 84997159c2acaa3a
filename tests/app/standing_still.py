"""The shortest mission there is, in a small world of its own, for tests of the command line that need a run."""
import json
import pathlib
import sys

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
HOME = {"position": [1.0, 0.5, 0.0], "orientation": [0.0, 0.0, 0.707106781, 0.707106781]}
YARD = """<mujoco>
  <option timestep="0.002" cone="elliptic" impratio="10"/>
  <worldbody>
    <geom name="ground" type="plane" size="10 10 1"/>
    <geom type="box" pos="0 6 1" size="5 0.1 1"/>
    <geom type="box" pos="0 -5 1" size="5 0.1 1"/>
    <geom type="box" pos="-5 0 1" size="0.1 6 1"/>
    <geom type="box" pos="5 0 1" size="0.1 6 1"/>
    <geom type="box" pos="2 4 0.5" size="0.4 0.3 0.5"/>
  </worldbody>
</mujoco>
"""


def standing_still(folder, more="", station=HOME):
    """A scenario file: to stand at home, where the robot starts, or to go to another station, in the world `yard` below `folder`."""
    world = folder / "worlds/yard"
    world.mkdir(parents=True, exist_ok=True)
    (world / "yard.xml").write_text(YARD)
    (folder / "models").mkdir(exist_ok=True)  # a folder of data has both
    visit = {"number": 1, "name": "home", "type": "home", **station, "accuracy": 0.2, "target": station["position"]}
    route = {"version": 1, "frame": "site", "datum": {"latitude_deg": 29.21, "longitude_deg": 119.46}, "start": HOME, "stations": [visit]}
    (folder / "home.json").write_text(json.dumps(route))
    file = folder / "home.yaml"
    file.write_text(f"world: yard\nmission: {folder / 'home.json'}\n" + more)
    return file
