"""Seeds of the scenarios in the tests: seeds.json, which `patrol test --seed-table` reads, too."""
import json
import pathlib

SEEDS = json.loads((pathlib.Path(__file__).parent / "seeds.json").read_text())


def seed_option(world, scenario):
    """Options of `patrol run` that select the seed of a scenario."""
    return ["--seed", str(SEEDS[f"worlds/{world}/scenarios/{scenario}.yaml"])]
