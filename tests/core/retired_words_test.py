#!/usr/bin/env python3
"""No retired word is left in names, settings keys, options, messages and pages; comments are not checked, except for "paper 00".

usage: retired_words_test.py SOURCE_DIR           tests
       retired_words_test.py SOURCE_DIR --list    prints the findings of each file and the number of each word
"""
import collections
import functools
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])

# Word: (pattern, scope, replacement, example). Scope "names": identifiers, settings keys, options, YAML keys; the pattern is
# matched against whole words of the name in lower case, joined by underscores. Scope "texts": messages, help and pages. A string
# without a space is a name.
NAMES, TEXTS, BOTH = ("names",), ("texts",), ("names", "texts")
RETIRED = {
    # Terms.
    "share": (r"shares?", BOTH, "ratio, fraction, probability or weight", "inlier_share"),
    "sighting": (r"sight(?:s|ed|ings?)", BOTH, "measurement, observation or detection", "Sighting"),
    "sight": (r"(?<!line_of_)sight", NAMES, "observation", "PredictedSight"),
    "way": (r"(?<!two_)(?<!one_)ways?", NAMES, "path, trajectory, distance or relative pose", "way_m"),
    "place": (r"(?<!in_)places?", NAMES, "pose, position, node or station", "T_map_place"),
    "believe": (r"(?:dis)?believe[sd]?|beliefs?", BOTH, "estimate, accept or confidence", "BeliefEvidence"),
    "doubt": (r"(?:un)?doubt(?:s|ed|ful)?", BOTH, "robust loss, down-weight, reject or inflate the covariance", "doubts_loops"),
    "judge": (r"judge[sd]?|judging|judge?ments?", BOTH, "evaluate, score, classify or gate", "judge_ranges"),
    "clump": (r"clumps?", BOTH, "cluster", "HeaviestClump"),
    "occasion": (r"occasions?", BOTH, "event or highlight", "Occasion"),
    "newcomer": (r"newcomers?", BOTH, "unmapped or dynamic obstacle", "newcomer_distance_m"),
    "stray": (r"stray(?:s|ed|ing)?", BOTH, "path deviation or outlier", "stray_m"),
    "lay": (r"lays?|laid", BOTH, "register, align, place or rasterize", "laid_on"),
    "evenly": (r"evenly", NAMES, "uniformly or systematic", "draw_evenly"),
    "blind": (r"blind(?:ly|ed)?", BOTH, "without lidar update or without detection", "max_blind_s"),
    "rival": (r"rivals?", BOTH, "second-best match or competing hypothesis", "rival_share"),
    "stranger": (r"strangers?", BOTH, "non-neighbor", "kStrangers"),
    "say": (r"say|says|said|unsaid", BOTH, "publish, report or indicate", "said_lost"),
    "hear": (r"hear|hears|heard", BOTH, "receive", "hear"),
    "tell": (r"tells?|(?:un)?told", BOTH, "constrain or report", "told_map_"),
    "know": (r"knows|knew", BOTH, "estimate, observe; given, prior", "knows_map"),
    "twin": (r"(?<!digital )twins?", BOTH, "simulator or simulation", "QuadrupedTwin"),
    "remote": (r"remote", NAMES, "teleop", "remote_silence_s"),
    "driver": (r"drivers?", NAMES, "operator", "driver_patience_s"),
    "prop": (r"props?", NAMES, "static obstacle or object", "Prop"),
    "belt": (r"belts?", BOTH, "track", "BeltCounters"),
    "grip": (r"grips?", BOTH, "traction or axial overlap", "lose_grip"),
    "trust": (r"(?:dis|un)?trust(?:s|ed)?", BOTH, "confidence", "assess_trust"),
    "most": (r"(?<!at_)most(?!_likely)", NAMES, "max", "kMostPoints"),
    "least": (r"(?<!at_)least(?!_squares)", NAMES, "min", "least_range_m"),
    "longest": (r"longest", NAMES, "max", "longest_pause_s"),
    "farthest": (r"farthest|furthest", NAMES, "max", "farthest_m"),
    "stretch": (r"stretch(?:es)?", NAMES, "segment", "min_stretches"),
    "blunder": (r"blunders?", BOTH, "outlier", "blunder_share"),
    "colophon": (r"colophon", BOTH, "footer", "colophon"),
    "paper": (r"paper_(?:dwa|local)", NAMES, "dwa_liu21", "PaperDwaSettings"),
    # Settings: one scheme for each quantity.
    "rthz": (r"rthz", BOTH, "per_sqrt_hz", "gyro_noise_radps_rthz"),
    "tol": (r"tol", BOTH, "tolerance", "staging_tol_m"),
    "patience": (r"patience", BOTH, "timeout", "blocked_patience_s"),
    "give_up": (r"give_up(?:_after)?", NAMES, "timeout or max_...", "give_up_s"),
    "silence_s": (r"silence_s", NAMES, "timeout_s", "remote_silence_s"),
    "memory_s": (r"memory_s", NAMES, "persistence_s (obstacles) or buffer_s (data)", "obstacle_memory_s"),
    "decel": (r"decel|max_accel", NAMES, "max_acceleration, max_deceleration", "approach_decel_mps2"),
    # Wording of messages.
    "somebody": (r"(?:some|no|any)body|whoever", BOTH, "the thing that is meant", "somebody stopped it"),
    "stands": (r"(?:stands?|stood) (?:there|in|on|at|by|below|above|before|already|nowhere)", TEXTS,
               "is in; duplicate", "the key stands there twice"),
    "lies": (r"l(?:ie|ies|ay|ying) (?:in|on|at|outside|beyond|between|below|above|before|behind|within|there|nowhere)", TEXTS,
             "must be in [a, b]; is outside", "must lie in 0 ... 1"),
    "there is no": (r"there (?:is|are|was|were) (?:no|none|nothing|not)", TEXTS, "unknown X; X not found", "there is no such key"),
    "has not come": (r"(?:has|have) not come", TEXTS, "incomplete", "the log has not come to its end"),
    "so many": (r"so (?:many|far|often|much)", TEXTS, "at most N, up to d, every N", "so many scans"),
    "likewise": (r"likewise", TEXTS, "the noun again", "likewise for the lidar"),
    # Spelling.
    "centre": (r"(?:epi)?centre[sd]?|centring", BOTH, "center", "turn_centre_x_m"),
    "neighbour": (r"neighbour(?:s|ed|ing|hoods?)?", BOTH, "neighbor", "neighbours_for"),
    "metre": (r"(?:centi|milli|kilo|micro|deci)?metres?|litres?|fibres?", BOTH, "meter", "too short by a metre"),
    "grey": (r"grey(?:s|ish)?", BOTH, "gray", "grey_noise_m"),
    "colour": (r"colour(?:s|ed|ing|less)?", BOTH, "color", "colour_of"),
    "our": (r"behaviours?|favour(?:s|ed|ite|able)?|vapour|harbours?|honour(?:s|ed)?|manoeuvres?", BOTH,
            "behavior, favor, vapor, maneuver", "recovery_behaviours"),
    "ise": (r"(?:de|re|un|non)?(?:local|optim|initial|normal|visual|linear|minim|maxim|summar|recogn|discret|raster|synchron|serial|"
            r"parametr|quant|regular|general|organ|stabil|random|categor|real|util|author|central|equal|neutral|vector|token|triangular|"
            r"factor|marginal|orthonormal|penal|emphas|character|standard|final|sanit|material|polar|ion|real|isation)is(?:e|es|ed|er|ers|ing|ation|ations)",
            BOTH, "-ize", "localise"),
    "doubled l": (r"(?:travel|label|level|model|signal|tunnel|channel|cancel|fuel|marvel|panel|pencil)l(?:ed|ing|er|ers)", BOTH,
                  "traveled, labeled, leveling, modeling", "kLevelling_per_s"),
    "other spelling": (r"analys(?:e|ed|ing)|catalogues?|programmes?|artefacts?|licence[sd]?|defence|aluminium|grams?mes?|tyres?|judgement",
                       BOTH, "analyze, catalog, program, artifact, license", "analyse"),
}
PAPER = re.compile(r"paper[s]?[ _]?0" + "0", re.I)

# Retired words that stay: (word, file, pattern that the whole name or text must contain, reason). An entry that nothing uses
# makes the test fail.
CONTRACT = "key of metrics.json: contract"
STREAM = "name of a random stream: another name changes the run of every seed"
ALLOWED = [
    ("say", "*", r"\bsaid_lost_s$", CONTRACT),
    ("doubt", "*", r"\bdoubted_(s|before_straying)$", CONTRACT),
    ("stray", "*", r"\b(strayed_s|doubted_before_straying)$", CONTRACT),
    ("share", "src/app/scoring/*.cc", r"^degenerate_share$", CONTRACT),
    ("place", "src/app/*/*", r"^(rings\.\*\.|max_)?place_error_m$", CONTRACT),
    ("trust", "src/app/scoring/*.cc", r"^(min_trust|trust_rank_correlation|trust_detection)$", CONTRACT),
    ("trust", "src/app/campaign/test/limit_rules.h", r"^(localization\.min_trust|localizability\.trust_rank_correlation|localizability\.trust_detection)$", CONTRACT),
    ("stretch", "src/app/commands/calibrate_command.cc", r"^stretches$", CONTRACT),
    ("way", "src/app/plan/tour_output.cc", r"^(way_.*|num_ways)$", CONTRACT),
    ("least", "src/app/plan/problem_output.cc", r"^least$", CONTRACT),
    ("trust", "src/app/scoring/save_scored_run.cc", r"^trust$", "column of localizability.csv: contract"),
    ("way", "src/app/commands/slam_command.cc", r"^(odometry_)?way_m$", CONTRACT),
    ("way", "src/app/mapping/mapped_log.h", r"^way_m$", CONTRACT),
    ("way", "src/app/mapping/mapping_page.cc", r"^(odometry_)?way_m$", CONTRACT),
    ("remote", "src/sim/teleop_operator.cc", r"^remote/hand$", STREAM),
    ("neighbour", "src/slam/submaps/neighbor_examples.cc", r"^slam/neighbour_examples$", STREAM),
    ("sighting", "src/studies/landmark_world.cc", r"^study/sights$", STREAM),
    ("remote", "src/monitor/http_server.cc", r"^remote_endpoint$", "function of Boost.Asio"),
    ("share", "src/app/scenario/data_folders.cc", r"^share/patrol$", "folder of the installed data"),
    ("share", "src/render/canvas.cc", r"^/usr/share/fonts/", "folder of the system's fonts"),
    ("place", "src/io/*/*", r"^place_?$", "position in a file, which an error message names"),
]
# They list former settings keys and options, which are refused with the present name.
SKIPPED = ("src/io/yaml/renamed_scenario_keys.cc", "src/io/yaml/renamed_stack_keys.cc", "src/app/cli/renamed_options.cc")

TOKEN = re.compile(
    r"(?P<comment>//[^\n]*|/\*.*?\*/)"
    r'|(?P<raw>(?:u8|[LuU])?R"(?P<mark>[^()\s\\]{0,16})\((?P<inside>.*?)\)(?P=mark)")'
    r'|(?P<string>(?:u8|[LuU])?"(?P<text>(?:[^"\\\n]|\\.)*)")'
    r"|(?P<number>(?<!\w)\.?\d(?:[\w.]|'(?=\w)|(?<=[eEpP])[+-])*)"
    r"|(?P<character>(?:u8|[LuU])?'(?:[^'\\\n]|\\.)+')"
    r"|(?P<name>[A-Za-z_]\w*)", re.S)
VERB = re.compile(r"place(_[a-z_]+)?$")  # before "(": a function that places something
ESCAPE = re.compile(r'\\(?:x[0-9a-fA-F]+|u[0-9a-fA-F]{4}|.)')
NAME_IN_TEXT = re.compile(r"[A-Za-z]\w*(?:_\w+|(?<=[a-z])[A-Z]\w*)")
FLOW_KEY = re.compile(r"(?:^[ -]*|[{,] *)([A-Za-z_]\w*):(?: |$)")
JS_STRING = re.compile(r"//[^\n]*|/\*.*?\*/|'(?:[^'\\\n]|\\.)*'|\"(?:[^\"\\\n]|\\.)*\"|`(?:[^`\\]|\\.)*`", re.S)

# Names are checked as "_word_word_", texts in lower case.
IN_NAME = {word: re.compile(rf"(?<=_)(?:{row[0]})(?=_)") for word, row in RETIRED.items()}
IN_TEXT = {word: re.compile(rf"(?<![a-z])(?:{row[0]})(?![a-z])") for word, row in RETIRED.items()}
ANY_IN_NAME = re.compile(rf"(?<=_)(?:{'|'.join(row[0] for row in RETIRED.values() if 'names' in row[1])})(?=_)")
ANY_IN_TEXT = re.compile(rf"(?<![a-z])(?:{'|'.join(row[0] for row in RETIRED.values() if 'texts' in row[1])})(?![a-z])")

Finding = collections.namedtuple("Finding", "word file line subject")


def words_of(name):
    """The words of a name in lower case with an underscore before, between and after them: kMaxRange_m -> _k_max_range_m_."""
    parts = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", name)
    return "_" + "_".join(part.lower() for part in parts) + "_"


@functools.cache
def words_in_name(name):
    words = words_of(name)
    if not ANY_IN_NAME.search(words):
        return []
    return [word for word, (_, scope, _, _) in RETIRED.items() if "names" in scope and IN_NAME[word].search(words)]


def words_in_text(text):
    """Retired words of a message; the names that it holds are checked as names."""
    found = {word for name in NAME_IN_TEXT.findall(text) for word in words_in_name(name)}
    prose = NAME_IN_TEXT.sub(" ", text).lower()
    if ANY_IN_TEXT.search(prose):
        found.update(word for word, (_, scope, _, _) in RETIRED.items() if "texts" in scope and IN_TEXT[word].search(prose))
    return sorted(found)


def words_in_string(text):
    """A string without a space is a name or several (a key, a path, an option)."""
    if " " in text.strip():
        return words_in_text(text)
    return sorted({word for name in re.findall(r"\w+", text) for word in words_in_name(name)})


def in_cpp(path, text):
    for token in TOKEN.finditer(text):
        if token["name"]:
            subject, words = token["name"], words_in_name(token["name"])
            if VERB.match(subject) and re.match(r"\s*\(", text[token.end():token.end() + 8]):
                continue
        elif token["string"] or token["raw"]:
            subject = token["inside"] if token["raw"] else ESCAPE.sub(" ", token["text"])
            words = words_in_string(subject)
        else:
            continue
        if words:
            line = text.count("\n", 0, token.start()) + 1
            yield from (Finding(word, path, line, subject) for word in words)


def in_yaml(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        for key in FLOW_KEY.findall(re.sub(r"(?:^|\s)#.*", "", line)):
            yield from (Finding(word, path, number, key) for word in words_in_name(key))


def in_script(path, text):
    for string in JS_STRING.finditer(text):
        if string[0].startswith("/"):
            continue
        line = text.count("\n", 0, string.start()) + 1
        subject = re.sub(r"\$\{[^}]*\}", " ", ESCAPE.sub(" ", string[0][1:-1]))
        yield from (Finding(word, path, line, subject) for word in words_in_string(subject))


def in_html(path, text):
    shown = re.sub(r"<(script|style)\b.*?</\1>|<!--.*?-->|<[^>]*>", lambda tag: "\n" * tag[0].count("\n") or " ", text, flags=re.S)
    for number, line in enumerate(shown.splitlines(), 1):
        yield from (Finding(word, path, number, line.strip()) for word in words_in_text(line))


def in_file(path, text):
    """All findings of a file, by its kind."""
    kind = path.rsplit(".", 1)[-1]
    reader = {"h": in_cpp, "cc": in_cpp, "yaml": in_yaml, "js": in_script, "html": in_html}.get(kind)
    found = list(reader(path, text)) if reader else []
    found += [Finding("paper 00", path, text.count("\n", 0, match.start()) + 1, match[0]) for match in PAPER.finditer(text)]
    return found


def files():
    """{path: text} of everything that is checked."""
    checked = [file for file in (ROOT / "src").rglob("*") if file.suffix in (".h", ".cc", ".js", ".html", ".md")]
    checked += [file for folder in ("worlds", "models") for file in (ROOT / folder).rglob("*") if file.suffix in (".yaml", ".md")]
    checked += [ROOT / "README.md", *sorted((ROOT / "tests").glob("**/*.md")), *sorted((ROOT / "tools").glob("*.md"))]
    return {file.relative_to(ROOT).as_posix(): file.read_text() for file in sorted(checked)
            if file.relative_to(ROOT).as_posix() not in SKIPPED}


def is_allowed(finding, entry):
    word, file, pattern, _ = entry
    return word == finding.word and pathlib.PurePath(finding.file).match(file) and re.search(pattern, finding.subject) is not None


def split_allowed(found, allowed):
    """(findings that no entry allows, entries that allow nothing)"""
    used = set()
    left = []
    for finding in found:
        entries = [i for i, entry in enumerate(allowed) if is_allowed(finding, entry)]
        used.update(entries)
        if not entries:
            left.append(finding)
    return left, [entry for i, entry in enumerate(allowed) if i not in used]


def described(finding):
    replacement = RETIRED[finding.word][2] if finding.word in RETIRED else "key of the reference (src/REFERENCES.md)"
    subject = re.sub(r"\s+", " ", finding.subject)
    return f"{finding.file}:{finding.line}: '{subject[:90]}': {finding.word}: use {replacement}"


@functools.cache
def all_findings():
    return [finding for path, text in files().items() for finding in in_file(path, text)]


class RetiredWords(unittest.TestCase):
    maxDiff = None

    def test_no_retired_word_is_used(self):
        left, _ = split_allowed(all_findings(), ALLOWED)
        self.assertEqual([described(finding) for finding in left[:40]], [], f"{len(left)} retired words")

    def test_every_allowed_word_is_still_used(self):
        self.assertEqual(split_allowed(all_findings(), ALLOWED)[1], [])

    def test_files_of_each_kind_were_read(self):
        kinds = collections.Counter(path.rsplit(".", 1)[-1] for path in files())
        self.assertGreater(min(kinds[kind] for kind in ("h", "cc", "js", "yaml", "md")), 4)

    def test_the_example_of_each_word_is_found(self):
        for word, (_, scope, _, example) in RETIRED.items():
            self.assertIn(word, words_in_string(example), example)
            if " " not in example:
                self.assertIn(word, [f.word for f in in_file("src/a.h", f"int {example} = 0;")], example)
                self.assertIn(word, [f.word for f in in_file("src/a.cc", f'visit("{example}", self.x);')], example)
                self.assertIn(word, [f.word for f in in_file("worlds/a.yaml", f"stack: {{{example}: 1}}")], example)

    def test_planted_words_are_found_wherever_they_can_be(self):
        planted = {
            "src/a.h": "constexpr int kMostCells = 3;",
            "src/a.cc": 'throw InputError("nobody is at home");',
            "src/app/cli/command_line.cc": 'app.add_option("--loop-patience", x, "Timeout, s");',
            "worlds/a/scenarios/b.yaml": "stack:\n  plan:\n    patience_s: 3  # comment\n",
            "src/monitor/page/page.js": "show('The colour of the robot');",
            "src/monitor/page/index.html": "<p>Whoever changes <b>this</b></p>",
            "src/b.h": "/// Paper 00" + "2, section 3.\n",
        }
        for path, text in planted.items():
            self.assertEqual(len(in_file(path, text)), 1, path)

    def test_words_that_only_look_alike_are_not_found(self):
        harmless = """
            std::shared_ptr<Grid> shared; always_free(waypoint); emplace_back(x); std::in_place; turn_in_place();
            placeholder; place(x); place_obstacle(x); two_way_ranging; at_most(3); least_squares(); layer; known_map; line_of_sight; tolerance_m; // share
            auto x = 1'000'000; char c = '"'; log("At least one robot, at most three, is still in the shared frame.");
            R"(shared always)"; neighbor; center; color; parameter; diameter; premise; precise; raised; property;
        """
        self.assertEqual([f for f in in_file("src/a.cc", harmless)], [])
        self.assertEqual(in_file("worlds/a.yaml", "name: share  # share: 3\nat: {x: share}"), [])

    def test_an_entry_of_the_allow_list_allows_its_own_word_in_its_own_file(self):
        found = in_file("src/a.cc", 'int share; f("share");') + in_file("src/b.cc", "int share;")
        left, unused = split_allowed(found, [("share", "src/a.cc", r"^share$", "reason"), ("grip", "src/a.cc", r"", "reason")])
        self.assertEqual([finding.file for finding in left], ["src/b.cc"])
        self.assertEqual([entry[0] for entry in unused], ["grip"])


def print_findings():
    left, unused = split_allowed(all_findings(), ALLOWED)
    for finding in left:
        print(described(finding))
    for entry in unused:
        print("unused entry of the allow-list:", entry)
    for word, number in collections.Counter(finding.word for finding in left).most_common():
        print(f"{number:6} {word}")


if __name__ == "__main__":
    if sys.argv[2:] == ["--list"]:
        print_findings()
    else:
        unittest.main(argv=[sys.argv[0], "-v"])
