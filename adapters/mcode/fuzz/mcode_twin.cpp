// Fuzz: the language of the MCode twin: tokenizer, compiler, program editor, interpreter and the link's line splitter.
// In: the fuzzer's bytes. Out: nothing; laws: bounds hold, lines keep their order, a program survives being written and read back,
// no statement runs without giving a known error code.
#include <fuzzer/FuzzedDataProvider.h>

#include "adapters/mcode/twin/comm.hpp"
#include "adapters/mcode/twin/run.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using namespace axisgate::mcode::twin;
using fuzz::require;

namespace {

struct Nothing final : Host {
    Number read(Word w, int& error) override {
        if (info(w).access == mcode::twin::Access::none) error = 35;
        return Number::of(1);
    }
    int write(Word, std::span<const Number> fields) override { return fields.empty() ? 21 : 0; }
    int perform(const Statement&, std::span<const Number> fields) override { return fields.size() > Run::field_limit ? 21 : 0; }
    bool moving() override { return false; }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 8 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    Program program;
    Nothing host;
    Run run(program, host);
    Comm comm;
    comm.flags.py = in.ConsumeBool();
    comm.flags.ck = in.ConsumeIntegralInRange(0, 2);
    comm.flags.em = in.ConsumeIntegralInRange(0, 3);
    comm.flags.es = in.ConsumeIntegralInRange(0, 3);
    std::int32_t address = 1;
    bool programming = false;
    std::string echo;
    while (in.remaining_bytes() > 0) {
        if (comm.receive(in.ConsumeIntegral<std::uint8_t>(), echo).kind != LinkEvent::Kind::command) continue;
        const auto command = comm.take();
        require(command.text.size() <= line_limit + 1, "a line is bounded");
        if (command.text == "PG") {
            programming = !programming;
            address = in.ConsumeIntegralInRange(-5, 20000);
            continue;
        }
        int code = 0;
        if (programming) {
            code = program.enter(command.text, address);
        } else {
            code = run.execute(program.compile_typed(command.text), {});
        }
        require(code >= 0 && code <= 111, "an error code of the list");
        require(echo.size() <= 2 * size + 2, "the echo is not longer than what came");
    }
    std::int32_t end = 0;
    for (const auto& l : program.lines()) {
        require(l.address > end, "lines do not overlap");
        end = l.address + static_cast<std::int32_t>(l.text.size());
        require(end <= Program::space, "programs stay within their space");
    }
    require(program.symbols().defined() <= Symbols::defined_limit, "192 names");
    if (!program.empty()) run.start(0);
    for (int i = 0; i < 2000 && !run.idle(); ++i) {
        if (!run.awake(Instant{} + std::chrono::hours(i))) continue;
        const int code = run.step(Instant{} + std::chrono::hours(i));
        require(code >= 0 && code <= 111, "an error code of the list");
    }
    const std::string text = program.text();
    Program again;
    again.load(text);
    require(again.lines().size() <= program.lines().size(), "reading back invents nothing");
    return 0;
}
