"""Measures each function that is defined in gateway/ or adapters/, for the rule "a function is one thing".

In: the text of a source or a header. Out: (function, line, lines, branches) of each. Lines are those from the function's head to the brace
that closes it. Branches are `if`, `for`, `while`, `case`, `catch`, `?`, `&&` and `||`: each place at which one run of the function can
differ from another. A lambda within a function is a part of it; one in a table outside of functions is a function by itself.
A simple reading of text as clang-format writes it, without a compiler: a blank before `&&` tells the operator from a reference, and
macros are not looked into.
"""
import re

LINES = 80
BRANCHES = 40

_HIDDEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"([^(\s"]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*',
                     re.S | re.M)
_BRANCH = re.compile(r"\b(?:if|for|while|case|catch)\b|\?|(?<=\s)&&|\|\|")
_SCOPE = re.compile(r"^(?:inline\s+)?namespace\b|^extern\s*\"\"\s*$")
_CLASS = re.compile(r"^(?:template\s*<.*>\s*)?(?:typedef\s+)?(?:class|struct|union)\b(?:\s*(?:alignas\([^)]*\)|\[\[[^\]]*\]\]))*\s*(?P<name>[A-Za-z_][\w:]*)?", re.S)
_NAME = re.compile(r"((?:[\w~]+(?:<[^<>()]*>)?::)*(?:operator\s*(?:\(\)|\[\]|[^\s\w(]+|[\w:<>]+)|~?\w+))\s*$")
_OPERATOR = re.compile(r"\boperator\s*(?:\(\)|\[\]|[^\s\w(]+)?")
_ACCESS = re.compile(r"\s*(?:(?:public|protected|private)\s*:(?!:)\s*)*")
_LAMBDA = re.compile(r"\[[^\[\]]*\]\s*(?:\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\)\s*)?(?:mutable\s*)?(?:noexcept\s*)?(?:->\s*[\w:<>,&* ]+?\s*)?$")


def _plain(text):
    """The text without comments, strings and directives, line by line where it was."""
    return _HIDDEN.sub(lambda m: ('""' if m.group(0)[0] in "\"R'" else " ") + "\n" * m.group(0).count("\n"), text)


def _closing(text, at):
    """The place behind the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] in "({[") - (text[i] in ")}]")
        if depth == 0:
            return i + 1
    return len(text)


def _parameters(head):
    """Where the list of parameters begins in the head of a function; None for what is no function."""
    depth, at = 0, 0
    while at < len(head):
        c = head[at]
        operator = _OPERATOR.match(head, at)
        if operator:
            at = operator.end()
            continue
        if c in "<>":
            depth += (c == "<") - (c == ">" and head[at - 1] != "-")
        elif depth <= 0 and c == "=":
            return None
        elif c == "(":
            if depth <= 0 and not re.search(r"\b(?:alignas|decltype|noexcept|explicit|requires)\s*$", head[:at]):
                return at
            at = _closing(head, at)
            continue
        elif c == "[":
            at = _closing(head, at)
            continue
        at += 1
    return None


def _add(text, start, end, name, found):
    start = _ACCESS.match(text, start, end).end()
    body = text[start:end]
    found.append((name, text.count("\n", 0, start) + 1, body.count("\n") + 1, len(_BRANCH.findall(body))))


def _lambdas(text, at, end, found):
    """The lambdas of a declaration that is no function, such as a table."""
    start, table = at, _NAME.search(re.split(r"[={\[;]", text[at:end])[0].rstrip())
    while at < end:
        if text[at] == "{" and (m := _LAMBDA.search(text, start, at)):
            to = _closing(text, at)
            _add(text, m.start(), to, f"{table[1] if table else ''} (a lambda)", found)
            at = to
        else:
            at += 1


def _walk(text, at, scope, found):
    """Reads definitions from `at` to the brace that closes the scope (or the file), and returns the place behind it."""
    start = at
    while at < len(text):
        c = text[at]
        if c == "}":
            return at + 1
        if c == ";":
            _lambdas(text, start, at, found)
            at = start = at + 1
        elif c in "([":
            at = _closing(text, at)
        elif c == "{":
            head = text[_ACCESS.match(text, start, at).end():at].strip()
            of_class = _CLASS.match(head)
            parameters = _parameters(head)
            if _SCOPE.match(head):
                at = start = _walk(text, at + 1, scope, found)
            elif of_class and parameters is None and "=" not in re.sub(r"<.*?>", "", head, flags=re.S):
                at = _walk(text, at + 1, [*scope, of_class["name"] or "(unnamed)"], found)
                start = at
            # In a list of initializers a brace follows its member without a blank; a body has one.
            elif parameters is None or re.search(r"\)[^()]*:\s", head[parameters:]) and re.match(r"[\w>]", text[at - 1]):
                at = _closing(text, at)
            else:
                to = _closing(text, at)
                name = _NAME.search(head[:parameters].rstrip())
                _add(text, start, to, "::".join([*scope, name[1] if name and not name[1].isupper() else " ".join(head.split())]), found)
                at = start = to
        else:
            at += 1
    return at


def functions_of(text):
    """[(function, line, lines, branches)] of one file."""
    found, plain, at = [], _plain(text), 0
    while at < len(plain):
        at = _walk(plain, at, [], found)
    return found


def unread(text):
    """Lines with a statement that belong to none of the functions which were found: there the reading above is wrong."""
    within = {n for _, line, lines, _ in functions_of(text) for n in range(line, line + lines)}
    return [n for n, line in enumerate(_plain(text).split("\n"), 1) if n not in within and re.search(r"\b(?:return|if|for|while|switch)\b", line)]


def faults_of(measured):
    """(path, function, line, lines, branches) of functions -> what is wrong, one line each."""
    for path, name, line, lines, branches in measured:
        if lines > LINES or branches > BRANCHES:
            yield f"{path}:{line}: {name} has {lines} lines and {branches} branches, and {LINES} and {BRANCHES} are enough: it is two things"


# What is measured and how, by an example: each function with its lines and its branches.
EXAMPLE = '''
namespace a::b {
constexpr const char* listing = R"(if (a) { while && for (;;) { case )";
constexpr Row rows[] = {
    {"one", 1, [](int x) { return x > 0 ? x : -x; }},  // if this were counted, for example
    {"two", 2, nullptr},
};
Door::Door(int x, std::function<void(int)> f)
    : x_(x && f), y_{x}, f_([](int v) {
          if (v) go();
      }) {}
template <class F>
[[nodiscard]] std::optional<int> visit(F&& f, const char* text = "if (x) {") {
    auto&& each = f();
    for (const auto& e : each) {
        if (e > 0 && e < 3 || e == '?') return e;
        switch (e) {
            case 1:
            case 2: return go([&] { while (e--) {} });
            default: break;
        }
    }
    struct Local {
        int one() const { return 1; }
    };
    try {
        do {
        } while (false);
    } catch (const std::exception&) {
    }
    return std::nullopt;
}
class C {
public:
    C& operator+=(const C& o) noexcept {
        return *this;
    }

private:
    bool operator()(int x) const { return x ? true : false; }
    explicit operator bool() const;
    std::function<bool(int)> decides_ = [](int x) { return x && y; };
    int x_{3};
};
}  // namespace a::b
'''
MEASURED = [("rows (a lambda)", 5, 1, 1), ("Door::Door", 8, 4, 2), ("visit", 12, 21, 9), ("C::operator+=", 35, 3, 0), ("C::operator()", 40, 1, 1),
            ("decides_ (a lambda)", 42, 1, 1)]


def holds():
    """Whether the rule still finds what it is for."""
    if functions_of(EXAMPLE) != MEASURED:
        return False

    def refused(text):
        return len(list(faults_of([("x.cpp", *m) for m in functions_of(text)])))
    most = "void f() {\n" + "    go();\n" * (LINES - 2) + "}\n" + "int g() {\n    return " + "a &&\n " * BRANCHES + "b;\n}\n"
    long = "void f() {\n" + "    go();\n" * (LINES - 1) + "}\n"
    branched = "int f() {\n    return " + "a ||\n " * (BRANCHES + 1) + "b;\n}\n"
    if unread(EXAMPLE) or unread("#define X(a) { if (a) return; }\n") or unread("int x = {\n    return;\n};\n") != [2]:
        return False
    return (refused(most), refused(long), refused(branched)) == (0, 1, 1)
