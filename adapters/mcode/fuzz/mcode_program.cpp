// Fuzz: program text for MCode as a person writes it, before a drive's memory is touched, and what a drive might list of it.
// In: the fuzzer's bytes: the text, and behind a zero a listing. Out: nothing; laws: lines to send or a fault that names its line; what is
// sent are whole lines of the language within its bounds; a program that was checked lists without a difference.
#include "adapters/mcode/native_program.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using namespace axisgate::mcode;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 32 * 1024) return 0;
    static const Language language(*fuzz::families().find("mcode").catalogue);
    const std::string_view all(reinterpret_cast<const char*>(data), size);
    const std::string_view text = all.substr(0, all.find('\0'));
    const ProgramText checked = check_program(text, language);
    const auto lines = static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; })) + 1;
    require(checked.lines.size() <= program_line_limit + 2 || !checked.fault.empty(), "a download is bounded");
    if (checked.fault.empty()) {
        std::string listing;
        bool within = false;
        for (const ProgramLine& l : checked.lines) {
            require(!l.text.empty() && l.text.size() <= 64, "a line is no longer than the drive's");
            require(l.number <= lines, "and has its place in the text");
            for (const char c : l.text)
                require(c >= 0x20 && c < 0x7F, "printable ASCII");
            if (l.kind == ProgramLine::Kind::frame) within = !within;
            if (l.kind == ProgramLine::Kind::stored) listing += l.text + "\r\n";
        }
        require(!within, "program mode is left again");
        std::size_t count = 0;
        (void)listing_fault(checked.lines, listing, count);
    }
    const std::string_view listing = all.find('\0') == std::string_view::npos ? all : all.substr(all.find('\0') + 1);
    std::size_t count = 0;
    (void)listing_fault(checked.lines, listing, count);
    require(listed_lines(listing).size() <= listing.size() + 1, "a listing gives no more lines than it has");
    require(stored_questions(listing).count <= listing.size(), "nor more questions");
    const std::string_view line = listing.substr(0, std::min<std::size_t>(listing.find_first_of("\r\n"), 200));
    require(normal_form(normal_form(line)) == normal_form(line), "the normal form of a line is one");
    return 0;
}
