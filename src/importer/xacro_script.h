#pragma once

namespace patrol::importer {

/// Script that calls xacro: arguments FILE, ATTRIBUTE, N, N times NAME=FOLDER of packages, then NAME=VALUE of xacro
/// arguments. $(find PKG) is searched as by the class Packages. Each element of the output has its file and line as
/// ATTRIBUTE. Exit status 3: xacro is not installed; 4: the expansion failed, with the message on the standard output.
///
/// xacro's own messages have no lines. The script notes the line of each element in the DOM. The frames of the
/// exception name the element and the property that are being evaluated.
inline constexpr const char* kXacroScript = R"py(
import os, re, sys
try:
    import xacro
    from xacro import substitution_args
except ImportError as error:
    sys.stderr.write(str(error))
    sys.exit(3)
import xml.dom.minidom
from xml.dom.expatbuilder import ExpatBuilderNS
from xml.parsers.expat import ExpatError
file, attribute, count = os.path.abspath(sys.argv[1]), sys.argv[2], int(sys.argv[3])
given = dict(word.split('=', 1) for word in sys.argv[4:4 + count])
mappings = dict(word.split('=', 1) for word in sys.argv[4 + count:])
parse_package = xml.dom.minidom.parse
texts = {}  # of the files that are read, by path
properties = {}  # name to file and line

def package_name(folder):
    try:
        names = parse_package(os.path.join(folder, 'package.xml')).getElementsByTagName('name')
        return names[0].firstChild.data.strip()
    except Exception:
        return ''

def find(package):
    if package in given:
        return os.path.abspath(given[package])
    folder = os.path.dirname(file)
    while True:
        if os.path.basename(folder) == package or package_name(folder) == package:
            return folder
        if os.path.isdir(os.path.join(folder, package)):
            return os.path.join(folder, package)
        above = os.path.dirname(folder)
        if os.path.exists(os.path.join(folder, 'package.xml')):
            for name in sorted(os.listdir(above)):
                if package_name(os.path.join(above, name)) == package:
                    return os.path.join(above, name)
        if above == folder:
            raise Exception('unknown package "%s": give its folder with --package %s=FOLDER' % (package, package))
        folder = above

class KeepPosition:
    """Gives copies of an element its position."""
    def handle(self, operation, key, at, node, copy):
        if copy is not None:
            copy.setUserData(key, at, self)

class Builder(ExpatBuilderNS):
    """Notes the file and the line of each element."""
    def start_element_handler(self, name, attributes):
        super().start_element_handler(name, attributes)
        self.curNode.setUserData('at', (self.path, self.getParser().CurrentLineNumber), KeepPosition())

def parse(source, *options):
    builder = Builder()
    builder.path = os.path.normpath(source.name)
    texts[builder.path] = source.read()
    return builder.parseString(texts[builder.path])

def position(node):
    while node is not None and node.getUserData('at') is None:
        node = node.parentNode
    return node and node.getUserData('at')

grab_property = xacro.grab_property

def note_property(elt, table):
    properties[elt.getAttribute('name')] = position(elt)
    grab_property(elt, table)

def frames(error):
    """Frames of an error and of the errors that it wraps, from the outermost to the innermost one."""
    while error is not None:
        trace = error.__traceback__
        while trace is not None:
            yield trace.tb_frame
            trace = trace.tb_next
        error = getattr(error, 'exc', None)

def location_of(error):
    """File and line of the innermost element or property that is evaluated, and the names of the macros around it."""
    at, macros, call = (file, 0), [], None
    for frame in frames(error):
        function, local = frame.f_code.co_name, frame.f_locals
        if function == '_resolve_' and local['key'] in local['self'].unevaluated:
            at = properties.get(local['key']) or at
        elif function in ('eval_all', 'handle_macro_call', 'grab_property', 'grab_macro', 'process_include'):
            at = position(local.get('elt') or local.get('node')) or at
            if call and function == 'eval_all' and local['macros'] is call.get('scoped_macros'):
                macros.append(call['m'].body.getAttribute('name'))
        elif function == 'parse' and frame.f_code is parse.__code__ and isinstance(error, ExpatError):
            at = (local['builder'].path, error.lineno)
        call = local if function == 'handle_macro_call' else None
    return at, list(dict.fromkeys(reversed(macros)))

def line_in_tag(at, quoted):
    """Line of a text in the tag that begins in a line; this line without the text."""
    lines = texts.get(at[0], '').split('\n')
    for number in range(max(at[1], 1), len(lines) + 1):
        if any(text in lines[number - 1] for text in quoted):
            return number
        if '>' in lines[number - 1]:
            break
    return at[1]

def shown(path):
    """Path as the user writes that of the file: relative or absolute."""
    relative = os.path.relpath(path)
    if path == file:
        return sys.argv[1]
    return path if os.path.isabs(sys.argv[1]) or relative.startswith('..') else relative

def text_of(error):
    message = str(error) or type(error).__name__
    if isinstance(error, ExpatError):
        message = 'not an XML file: ' + re.sub(r': line \d+, column \d+$', '', message)
        return message.replace('XML or text declaration not at start of entity', '<?xml ...?> must be at its very start')
    if not isinstance(error, xacro.XacroException):
        message = '%s: %s' % (type(error).__name__, error)
    message = re.sub(r"<class '[^']*'>: ", '', ' '.join(message.split()))
    message = re.sub(r'^\[Errno \d+\] ', '', message)
    message = re.sub(r" \[Errno \d+\].*$", '', message)
    message = re.sub(r'^(.+) \1$', r'\1', message)
    for macro in getattr(error, 'macros', []):
        message += ' of macro %s' % macro.body.getAttribute('name')
    return message

def fail(error):
    at, macros = location_of(error)
    message = text_of(error)
    line = line_in_tag(at, re.findall("evaluating expression '(.*?)'", message))
    hint = ''
    missing = re.match(r'Undefined substitution argument (\S+)', message)
    if missing:
        message = 'argument %s has no value%s' % (missing[1], message[missing.end():])
        hint = ': give --xacro-arg %s=VALUE' % missing[1]
    print('%s%s: xacro: %s%s%s' % (shown(at[0]), ':%d' % line if line else '', message,
                                   ''.join(', in macro %s' % name for name in macros), hint))
    sys.exit(4)

def check_arguments():
    """Refuses an argument that no file reads. Names that are expressions may be any."""
    known, read = [], set()
    for text in texts.values():
        known += re.findall(r'<xacro:arg\s[^>]*?name\s*=\s*["\']([^"\']+)', text)
        known += re.findall(r'\$\(arg\s+([^\s)]+)\s*\)', text)
        read.update(re.findall(r'\barg\(\s*["\']([^"\']+)', text))
        for expression in re.findall(r'\$\(eval\s[^"<]*', text):
            read.update(re.findall(r'\w+', expression))
    if any('$' in name for name in known):
        return
    for name in mappings:
        if name not in known and name not in read:
            print('%s: xacro: --xacro-arg %s: unknown argument (known: %s)' % (
                sys.argv[1], name, ', '.join(dict.fromkeys(known)) or 'none'))
            sys.exit(4)

def write_positions(node):
    if node.nodeType == node.ELEMENT_NODE and node.getUserData('at'):
        path, line = node.getUserData('at')
        node.setAttribute(attribute, '%s:%d' % (shown(path), line))
    for child in node.childNodes:
        write_positions(child)

substitution_args._eval_find = find
substitution_args._eval_dict['find'] = find
xml.dom.minidom.parse = parse
xacro.grab_property = note_property
arguments = dict(mappings)
try:
    document = xacro.process_file(file, mappings=arguments)
except BaseException as error:
    fail(error)
check_arguments()
write_positions(document)
sys.stdout.buffer.write(document.toprettyxml(indent='  ', encoding='utf-8'))
)py";

}  // namespace patrol::importer
