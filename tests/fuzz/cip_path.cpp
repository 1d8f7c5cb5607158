// Fuzz target for paths and Forward_Open of an originator. Laws: reading ends within the bytes, and a path written here is read as the
// same.
#include "gateway/protocols/cip/path.hpp"

#include "gateway/protocols/cip/forward_open.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate::cip;
using axisgate::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider in(data, size);
    Bytes mine;
    const auto class_id = in.ConsumeIntegral<std::uint32_t>(), instance = in.ConsumeIntegral<std::uint32_t>(),
               attribute = in.ConsumeIntegral<std::uint32_t>();
    put_class(mine, class_id);
    put_instance(mine, instance);
    put_attribute(mine, attribute);
    const auto again = read_path(mine);
    require(again && again->class_id == class_id && again->instance() == instance && again->attribute == attribute,
            "what is written is read as the same");
    const bool large = in.ConsumeBool();
    const auto rest = in.ConsumeRemainingBytes<std::uint8_t>();
    std::size_t wrong_at = 0;
    if (!read_path(rest, wrong_at)) require(2 * wrong_at < rest.size() + 2, "where it is wrong is within it");
    OpenRequest open;
    Response refusal;
    if (!read_open(rest, large, open, refusal)) require(!refusal.good(), "what cannot be read is refused");
    return 0;
}
