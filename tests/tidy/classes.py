"""Counts the member functions of each class that a header of gateway/ or adapters/ defines, for the rule "a class is one thing".

In: the text of a header. Out: (class, functions) for each class and struct, nested ones by themselves. What counts is what stands between
the braces of the class: each function that is declared or defined there, with constructors, destructors, operators, static and template
ones, and each override. What does not: deleted ones, friends, types, members that hold functions, and what is inherited.
A simple reading of text as clang-format writes it, without a compiler: macros are not looked into.
"""
import re

LIMIT = 40

# Classes that are not mended yet, with their present number. It may only fall; at the limit the line goes.
NOT_MENDED = {
}

_HIDDEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', re.S | re.M)
_CLASS = re.compile(r"^(?:template\s*<.*>\s*)?(?:class|struct|union)\b(?:\s*(?:alignas\([^)]*\)|\[\[[^\]]*\]\]))*\s*([A-Za-z_]\w*)?", re.S)
_NO_FUNCTION = re.compile(r"^(?:using|typedef|friend|static_assert|enum|extern|namespace)\b")


def _closing(text, at):
    """The place behind the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(text)):
        depth += (text[i] in "({[") - (text[i] in ")}]")
        if depth == 0:
            return i + 1
    return len(text)


def _is_function(head):
    """Whether a member's text, up to its body or its end, declares a function."""
    head = re.sub(r"\b(?:public|protected|private)\s*:(?!:)|\[\[.*?\]\]|\balignas\s*\([^)]*\)", " ", head).strip()
    if _NO_FUNCTION.match(head) or re.search(r"=\s*delete\s*$", head):
        return False
    if re.search(r"\boperator\b", head):
        return True
    depth = 0
    for i, c in enumerate(head):
        if c == "<" or c == ">":
            depth += (c == "<") - (c == ">" and head[i - 1] != "-")
        elif depth <= 0 and c in "={":
            return False
        elif depth <= 0 and c == "(":
            return not head[i + 1:].lstrip().startswith("*")  # a pointer to a function is a member that holds one
    return False


def _walk(text, at, name, found):
    """Reads members from `at` to the brace that closes the class (or the file), and returns the place behind it."""
    start, functions = at, 0
    while at < len(text):
        c = text[at]
        head = re.sub(r"\b(?:public|protected|private)\s*:(?!:)", " ", text[start:at]).strip()
        if c == ";":
            functions += name is not None and _is_function(head)
            at = start = at + 1
        elif c == "}":
            break
        elif c in "([":
            at = _closing(text, at)
        elif c == "{":
            of_class = _CLASS.match(head)
            if of_class and "(" not in head.split("{")[0] and "=" not in re.sub(r"<.*?>", "", head, flags=re.S):
                at = _walk(text, at + 1, of_class.group(1) or "(unnamed)", found)
                continue  # up to its semicolon: it may name a member
            if name is None and re.match(r"^(?:inline\s+)?namespace\b|^extern\b", head):
                at = start = at + 1
                at = start = _walk(text, at, None, found)
                continue
            function = _is_function(head)
            # In a list of initializers a brace follows its member without a blank; a body has one.
            body = function and not (re.search(r"\)[^)]*:\s|\)\s*:", head) and re.match(r"\w", text[at - 1]))
            at = _closing(text, at)
            if body:
                functions += name is not None
                start = at
        else:
            at += 1
    if name is not None:
        found.append((name, functions))
    return at + 1


def functions_of(text):
    """[(class, member functions)] of one header, inner classes before those that they stand in."""
    found = []
    plain = _HIDDEN.sub(lambda m: '""' if m.group(0)[0] in "\"R'" else " ", text)
    at = 0
    while at < len(plain):
        at = _walk(plain, at, None, found)
    return found


def faults_of(headers):
    """(path, class, functions) of headers -> what is wrong, one line each."""
    left = dict(NOT_MENDED)
    for path, name, n in headers:
        allowed = left.pop((path, name), None)
        if allowed is None and n > LIMIT:
            yield f"{path}: {name} has {n} member functions, and {LIMIT} are enough: it is two things"
        elif allowed is not None and n > allowed:
            yield f"{path}: {name} has {n} member functions, {n - allowed} more than before: it is to become smaller"
        elif allowed is not None and n < allowed:
            yield f"{path}: {name} has {n} member functions now: tests/tidy/classes.py says {allowed}, " + (
                "take it out" if n <= LIMIT else "write what it has")
    for path, name in left:
        yield f"{path}: there is no {name}: take it out of tests/tidy/classes.py"


# What is counted and what is not, by an example: Outer has 9, its Inner has 1.
EXAMPLE = """
namespace a::b {
class Forward;
enum class Kind : std::uint8_t { one, two };
template <class T>
class Outer final : public Base<T> {
public:
    explicit Outer(int x) : x_(x), y_{2} { go({1}); }  // 1
    Outer(const Outer&) = delete;
    ~Outer();                                          // 2
    [[nodiscard]] virtual int one(std::function<void(int)> f = [](int) {}) const = 0;  // 3
    static constexpr int two() noexcept { return 2; }  // 4
    template <class F>
    void three(F&& f) {  // 5
        if (f()) { f(); }
    }
    bool operator==(const Outer&) const = default;  // 6
    auto four() const -> int;                       // 7
    friend void other(Outer&);
    using Callback = void (*)(int);
    std::function<void(int)> callback_;
    void (*pointer_)(int) = nullptr;
    int x_ = sizeof(int), y_{1};
    std::array<int, size(3)> sizes_{};
    struct Inner {
        int here() const { return 1; }
        enum class Sort { a, b } sort = Sort::a;
    } inner_;
    Outer& operator()(int) &;  // 8

private:
    void five(const std::string& text = "(;{", char c = ';');  // 9
};
int free_function();
inline int other_function() { return 1; }
}
"""


def holds():
    """Whether the rule still finds what it is for."""
    if functions_of(EXAMPLE) != [("Inner", 1), ("Outer", 9)]:
        return False
    large = "class Large {\n" + "    void f();\n" * (LIMIT + 1) + "};\n"
    refused = [f for f in faults_of([("x.hpp", *c) for c in functions_of(large)]) if "x.hpp" in f]
    listed = [f for f in faults_of([]) if "there is no" in f]
    return len(refused) == 1 and len(listed) == len(NOT_MENDED)
