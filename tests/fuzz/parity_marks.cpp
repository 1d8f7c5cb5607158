// Fuzz target for the removal of the kernel's parity marks from a serial port's bytes. Laws: the boundaries of runs have no effect, marked
// bytes are decoded correctly, nothing is invented, and a byte with an error is counted and is 0.
#include "gateway/lines/parity_marks.hpp"

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;

namespace {
std::vector<std::uint8_t> take(ParityMarks& marks, std::vector<std::uint8_t> part) {
    part.resize(marks.take_out(part));
    return part;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 4096) return 0;
    const std::vector<std::uint8_t> bytes(data, data + size);
    // Any bytes: in one piece and cut anywhere.
    ParityMarks whole, cut;
    const auto at_once = take(whole, bytes);
    std::vector<std::uint8_t> pieces;
    for (std::size_t i = 0; i < size;) {
        const std::size_t n = std::min<std::size_t>(1 + bytes[i] % 7, size - i);
        const auto got = take(cut, {bytes.begin() + static_cast<std::ptrdiff_t>(i), bytes.begin() + static_cast<std::ptrdiff_t>(i + n)});
        pieces.insert(pieces.end(), got.begin(), got.end());
        i += n;
    }
    require(at_once == pieces && whole.bad() == cut.bad(), "how a run is cut changes nothing");
    require(at_once.size() <= size, "nothing is invented");
    require(at_once.size() + 2 * whole.bad() <= size + 1, "a bad byte takes three");

    // With the kernel's marks: every fifth byte has an error.
    std::vector<std::uint8_t> marked, meant;
    std::uint64_t bad = 0;
    for (std::size_t i = 0; i < size; ++i) {
        if (bytes[i] % 5 == 0) {
            marked.insert(marked.end(), {0xFF, 0x00, bytes[i]});
            meant.push_back(0);
            ++bad;
        } else {
            marked.insert(marked.end(), bytes[i] == 0xFF ? 2 : 1, bytes[i]);
            meant.push_back(bytes[i]);
        }
    }
    ParityMarks marks;
    require(take(marks, marked) == meant && marks.bad() == bad, "what was meant is what is read");
    return 0;
}
