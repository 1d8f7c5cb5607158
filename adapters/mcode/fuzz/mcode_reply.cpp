// Fuzz: the reply parser of MCode: any bytes in any pieces, for any expectation.
// In: the fuzzer's bytes. Out: nothing; laws: an answer is ASCII and stood behind its mark, and what is kept is bounded.
#include <fuzzer/FuzzedDataProvider.h>

#include <cstdlib>

#include "adapters/mcode/wire_reply.hpp"

using namespace axisgate::mcode;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 8192) return 0;
    FuzzedDataProvider in(data, size);
    ReplyReader reader;
    while (in.remaining_bytes() > 0) {
        Expect e;
        e.kind = static_cast<Expect::Kind>(in.ConsumeIntegralInRange<int>(0, 3));
        e.mark = "#a";
        e.end_mark = in.ConsumeBool();
        e.checksum = in.ConsumeBool();
        e.prompt = in.ConsumeBool();
        reader.begin(e);
        for (int i = in.ConsumeIntegralInRange<int>(1, 8); i > 0; --i) {
            const Verdict v = reader.push(in.ConsumeRandomLengthString(200));
            if (reader.raw().size() > ReplyReader::limit) std::abort();
            if (v == Verdict::answered && e.kind == Expect::Kind::query) {
                if (reader.raw().find("#a" + reader.data()) == std::string::npos) std::abort();
                for (const char c : reader.data()) {
                    if (static_cast<unsigned char>(c) > 0x7E) std::abort();
                }
            }
            if (v != Verdict::waiting) break;
        }
        (void)reader.give_up();
        (void)plain_text(reader.raw(), "aPR P", e.checksum);
    }
    return 0;
}
