"""Records of measured tables, and the blocks of the documents that show them.

A record (tools/tables/NAME.json) holds the commit, date, seeds and commands of a table, and the values that it is made of. The block
between `<!-- results: NAME -->` and `<!-- end of results: NAME -->` in a document is made from the record alone; ctest Tools.Results
compares the two. A record of a table that tools/results has not made yet holds the table's text instead of values, and says so.
"""
import json
import os
import re
import subprocess

RECORDS = "tools/tables"
SHOWN_COMMANDS = 5  # of a table, in its caption
NOT_MADE = "Not made by `tools/results` yet"


class ResultsError(Exception):
    """Invalid input: one line for the user."""


def begin_mark(name):
    return f"<!-- results: {name} -->"


def end_mark(name):
    return f"<!-- end of results: {name} -->"


def block_in(text, name, file):
    """Text between the marks of a table, without the line breaks next to them."""
    begin, end = begin_mark(name), end_mark(name)
    if text.count(begin) != 1 or text.count(end) != 1 or text.index(begin) > text.index(end):
        raise ResultsError(f"{file}: {name}: must have the lines {begin} and {end} once, in this order")
    return text[text.index(begin) + len(begin):text.index(end)].strip("\n")


def replace_block(text, name, body, file):
    block_in(text, name, file)
    begin, end = begin_mark(name), end_mark(name)
    return text[:text.index(begin) + len(begin)] + "\n" + body + "\n" + text[text.index(end):]


def names_in(text):
    """Names of all blocks that a document begins."""
    return re.findall(r"^<!-- results: (\S+) -->$", text, re.M)


def caption(record):
    """Line above a table: commit, date, seeds and commands."""
    if not record["made"]:
        return f"*{NOT_MADE}. Commit: {record['commit']}. Date: {record['date']}. Seeds: {record['seeds']}. Command: {record['commands'][0]}.*"
    commands = "; ".join(f"`{command}`" for command in record["commands"][:SHOWN_COMMANDS])
    if len(record["commands"]) > SHOWN_COMMANDS:
        commands += f"; {len(record['commands']) - SHOWN_COMMANDS} more in `{RECORDS}/{record['name']}.json`"
    return (f"*By `tools/results --only {record['name']}` on {record['date']} at commit {record['commit']}. "
            f"Seeds: {record['seeds']}. {'Commands' if len(record['commands']) > 1 else 'Command'}: {commands}.*")


def body_of(record, text):
    return caption(record) + "\n\n" + text.strip("\n")


def record_file(root, name):
    return root / RECORDS / f"{name}.json"


def load_record(root, name):
    file = record_file(root, name)
    try:
        return json.loads(file.read_text())
    except FileNotFoundError:
        return None
    except ValueError as error:
        raise ResultsError(f"{file.relative_to(root)}: is not JSON: {error}") from None


def save_atomically(file, text):
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(file.name + ".part")
    part.write_text(text)
    os.replace(part, file)


def save_record(root, record):
    save_atomically(record_file(root, record["name"]), json.dumps(record, indent=1, ensure_ascii=False) + "\n")


def text_of(table, record):
    """Table in Markdown: from the values, or the text of a table that was not made by tools/results."""
    return table.text(record["values"]) if record["made"] else "\n".join(record["text"])


def write_block(root, table, record):
    file = root / table.file
    text = file.read_text()
    changed = replace_block(text, table.name, body_of(record, text_of(table, record)), table.file)
    if changed != text:
        save_atomically(file, changed)


def documents(root):
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard", "*.md"],
                            capture_output=True, text=True)
    if listed.returncode == 0:
        return [root / name for name in sorted(set(listed.stdout.splitlines())) if (root / name).exists()]
    return sorted(root.rglob("*.md"))


def results_outside(text):
    """Headers of tables outside of blocks that have the columns of a results table: a mean, a worst value, a result, or a seed."""
    text = re.sub(r"^<!-- results: (\S+) -->$.*?^<!-- end of results: \1 -->$", "", text, flags=re.M | re.S)
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    headers = re.findall(r"^(\|.*\|) *\n\|(?: *:?-+:? *\|)+ *$", text, re.M)
    return [header for header in headers
            if any(re.fullmatch(r"mean|worst|result|S = \d+|seed \d+", cell.strip()) for cell in header.strip("|").split("|"))]


def faults_of(root, tables):
    """One line for each block without a table, table without a record or a block, block that differs from its record, and results table
    outside of a block."""
    faults, known = [], {table.name: table for table in tables}
    for document in documents(root):
        place, text = document.relative_to(root).as_posix(), document.read_text()
        for name in names_in(text):
            if name not in known or known[name].file != place:
                faults.append(f"{place}: {name}: not a table of this file in tools/results_manifest")
        for header in results_outside(text):
            faults.append(f"{place}: {header}: a table of results outside of a block: add it to tools/results_manifest")
    for table in tables:
        try:
            record = load_record(root, table.name)
            if record is None:
                faults.append(f"{RECORDS}/{table.name}.json: not found")
                continue
            missing = [key for key in ("commit", "date", "seeds", "commands") if not record.get(key)]
            if missing:
                faults.append(f"{RECORDS}/{table.name}.json: without {', '.join(missing)}")
                continue
            text = (root / table.file).read_text()
            if block_in(text, table.name, table.file) != body_of(record, text_of(table, record)):
                faults.append(f"{table.file}: {table.name}: differs from {RECORDS}/{table.name}.json: run tools/results --render")
        except (ResultsError, KeyError, TypeError, ValueError) as error:
            faults.append(str(error) if isinstance(error, ResultsError) else f"{table.name}: cannot be rendered: {error!r}")
    return faults
