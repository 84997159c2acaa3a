"""The shortest mission there is, for tests of the command line that need a run."""
import json
import pathlib
import sys

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
STREET = SOURCE / "worlds/street"


def standing_still(folder, more=""):
    """A scenario file: to stand at home, where the robot starts."""
    route = json.loads((STREET / "routes/short.json").read_text())
    start = route["start"]
    route["stations"] = [{"number": 1, "name": "home", "type": "home", "position": start["position"],
                          "orientation": start["orientation"], "accuracy": 0.2, "target": start["position"]}]
    (folder / "home.json").write_text(json.dumps(route))
    file = folder / "home.yaml"
    file.write_text(f"world: street\nmission: {folder / 'home.json'}\n" + more)
    return file
