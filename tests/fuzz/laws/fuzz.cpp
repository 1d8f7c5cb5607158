// The common parts of all targets, compiled once.
#include "tests/fuzz/fuzz.hpp"

#include <cstdio>
#include <cstdlib>
#include <memory>

#include "gateway/core/assets.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate::fuzz {

void require(bool holds, const char* law) {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n", law);
    std::abort();
}

const Families& families() {
    static const Families all = [] {
        static std::vector<std::unique_ptr<Catalogue>> kept;
        Families f;
        for (const Family* x : all_families()) {
            std::vector<std::string> faults;
            auto c = Catalogue::parse(asset("schema/families/" + std::string(x->name) + ".json"), faults);
            require(c.has_value(), "the embedded catalogue can be read");
            kept.push_back(std::make_unique<Catalogue>(std::move(*c)));
            f.entries.push_back({x, kept.back().get()});
        }
        return f;
    }();
    return all;
}

Frame any_frame(FuzzedDataProvider& in) {
    Frame f;
    f.kind = static_cast<Frame::Kind>(in.ConsumeIntegralInRange<int>(0, 2));
    const std::size_t most = f.kind == Frame::Kind::bytes ? Frame::capacity : 8;
    if (f.kind != Frame::Kind::bytes) {
        f.extended = in.ConsumeBool();
        f.remote = in.ConsumeIntegralInRange<int>(0, 15) == 0;
        f.id = in.ConsumeIntegral<std::uint32_t>() & (f.extended ? 0x1FFFFFFFu : 0x7FFu);
    }
    f.assign(in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(0, most)));
    return f;
}

Value any_value(FuzzedDataProvider& in) {
    switch (in.ConsumeIntegralInRange<int>(0, 5)) {
        case 0:
            return Value{in.ConsumeBool()};
        case 1:
            return Value{in.ConsumeIntegral<std::int64_t>()};
        case 2:
            return Value{static_cast<std::int64_t>(in.ConsumeIntegral<std::int32_t>())};
        case 3:
            return Value{static_cast<std::int64_t>(in.ConsumeIntegral<std::uint8_t>())};
        case 4:
            return Value{in.ConsumeFloatingPoint<double>()};
        default:
            return Value{in.ConsumeRandomLengthString(24)};
    }
}

Duration any_step(FuzzedDataProvider& in) {
    switch (in.ConsumeIntegralInRange<int>(0, 7)) {
        case 0:
            return Duration{0};
        case 1:
            return Duration{in.ConsumeIntegralInRange<std::int64_t>(0, 2'000)};
        case 2:
        case 3:
            return Duration{in.ConsumeIntegralInRange<std::int64_t>(0, 1'000'000)};
        case 4:
        case 5:
            return Duration{in.ConsumeIntegralInRange<std::int64_t>(0, 100'000'000)};
        case 6:
            return Duration{in.ConsumeIntegralInRange<std::int64_t>(0, 10'000'000'000)};
        default:
            return Duration{in.ConsumeIntegralInRange<std::int64_t>(0, 10'000'000'000'000)};
    }
}

}  // namespace axisgate::fuzz
