// Fuzz target for the data sheet of a device whose axes and parameters have any names and values. Law: the written sheet is read back as
// the description says.
#include "tests/fuzz/eds_laws.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using namespace axisgate::cip;

namespace {
struct AnyDevice final : cip::Description {
    explicit AnyDevice(FuzzedDataProvider& in) {
        device_.name = in.ConsumeRandomLengthString(40);
        static constexpr DataType types[] = {DataType::boolean, DataType::sint,  DataType::int16,       DataType::dint,
                                             DataType::lint,    DataType::usint, DataType::uint16,      DataType::udint,
                                             DataType::real,    DataType::lreal, DataType::short_string};
        while (in.remaining_bytes() > 0 && parameters_.size() < 32) {
            ParameterInfo& p = parameters_.emplace_back();
            p.type = types[in.ConsumeIntegralInRange<std::size_t>(0, std::size(types) - 1)];
            p.name = in.ConsumeRandomLengthString(40);
            p.units = in.ConsumeRandomLengthString(20);
            p.help = in.ConsumeRandomLengthString(80);
            p.writable = in.ConsumeBool();
            for (Bytes* b : {&p.min, &p.max, &p.fallback}) {
                *b = in.ConsumeBytes<std::uint8_t>(size_of(p.type));
                b->resize(size_of(p.type));
            }
            const auto allowed = in.ConsumeIntegralInRange<int>(0, 3);
            for (int i = 0; i < allowed; ++i)
                p.allowed.emplace_back(in.ConsumeIntegral<std::int64_t>(), in.ConsumeRandomLengthString(80));
        }
    }
    const Device& device() const override { return device_; }
    std::optional<AssemblyInfo> assembly(std::uint32_t i) const override {
        using Role = AssemblyInfo::Role;
        if (i == 101) return AssemblyInfo{Role::input, 32};
        if (i == 151) return AssemblyInfo{Role::output, 32, 101};
        return AssemblyInfo{i == 197 ? Role::listen_only : i == 198 ? Role::input_only : Role::configuration, 0};
    }
    const std::vector<std::uint32_t>& assemblies() const override { return list_; }
    std::uint32_t parameters() const override { return static_cast<std::uint32_t>(parameters_.size()); }
    std::optional<ParameterInfo> parameter(std::uint32_t i) const override { return parameters_.at(i - 1); }

    Device device_;
    std::vector<ParameterInfo> parameters_;
    std::vector<std::uint32_t> list_{101, 151, 197, 198, 199};
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider in(data, size);
    const std::string name = in.ConsumeRandomLengthString(50);
    const AnyDevice d(in);
    const auto called = [&](std::uint32_t) { return name; };
    const char* const broken = laws::broken_by(d, {name, name, name, called, called});
    fuzz::require(!broken, broken ? broken : "");
    return 0;
}
