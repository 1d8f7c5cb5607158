// Registers the program's doors in a test program before its first test, as the program does before its first thread.
#include <cstdio>
#include <cstdlib>

#include "gateway/doors/dds/words.hpp"
#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"

namespace axisgate::test {
namespace {
[[maybe_unused]] const bool brought = [] {
    for (const DoorWords* words : {&modbus::door_words, &enip::door_words, &http::door_words, &dds::door_words}) {
        const std::string fault = bring(*words);
        if (fault.empty()) continue;
        std::fprintf(stderr, "%s\n", fault.c_str());
        std::abort();
    }
    return true;
}();
}  // namespace
}  // namespace axisgate::test
