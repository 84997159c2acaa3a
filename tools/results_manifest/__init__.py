"""Tables of measured results in the documentation: file, commands, values and text of each. Used by tools/results."""
from . import readme, street, tunnel, substation, faults, planning, recorded_logs, stacks, sites, studies, benchmarks, tutorials  # noqa: F401 each adds its tables
from .declare import TABLES  # noqa: F401

assert len({table.name for table in TABLES}) == len(TABLES)
