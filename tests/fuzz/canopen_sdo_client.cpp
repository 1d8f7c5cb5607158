// Fuzz target for the SDO client with a node that answers anything at any time. Laws: a transfer ends once and by its deadline, nothing
// grows beyond its bound, no call sends more than a block, and a successful end brings at most the limit.
#include "gateway/protocols/canopen/sdo_client.hpp"

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider in(data, size);
    canopen::SdoLimits limits;
    limits.most_bytes = in.ConsumeIntegralInRange<std::size_t>(1, 2000);
    limits.block_size = in.ConsumeIntegralInRange<std::uint8_t>(1, canopen::most_block_size);
    canopen::SdoClient client(5, limits);
    std::vector<Frame> out;
    Instant now = time_zero;
    const auto ended = [&](const std::optional<canopen::SdoEnd>& end) {
        require(out.size() <= canopen::most_block_size + 1u, "no call sends more than a block");
        for (const Frame& f : out)
            require(f.size == 8 && f.id == 0x605 && !f.extended, "a request has eight bytes");
        out.clear();
        require(client.busy() != (client.deadline() == never), "a transfer has a deadline, and nothing else has");
        if (!end) return;
        require(!client.busy(), "an end is the end");
        require(end->data.size() <= limits.most_bytes && (end->done() || end->data.empty()), "nothing of a value that is not whole");
        require(!canopen::to_text(*end).empty(), "an end can be told");
    };
    canopen::Address address;
    while (in.remaining_bytes() > 0) {
        if (!client.busy()) {
            address = {in.ConsumeIntegral<std::uint16_t>(), in.ConsumeIntegral<std::uint8_t>()};
            const bool block = in.ConsumeBool();
            if (in.ConsumeBool()) {
                client.read(address, now, out, block);
            } else {
                client.write(address, std::vector<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(0, 1000), 0x5A), now, out, block);
            }
            ended(std::nullopt);
        }
        switch (in.ConsumeIntegralInRange<int>(0, 5)) {
            case 0:
                now += fuzz::any_step(in);
                ended(client.on_deadline(now, out));
                break;
            case 1:
                ended(client.on_frame(fuzz::any_frame(in), now, out));
                break;
            case 2: {
                const std::uint8_t commands[]{0x43, 0x4F, 0x41, 0x40, 0x60, 0x00, 0x10, 0x01,
                                              0x20, 0x30, 0xC6, 0xA4, 0xA2, 0xA1, 0xD5, 0x80};
                const canopen::Address at = in.ConsumeIntegralInRange<int>(0, 7) == 0 ? canopen::Address{0x1008, 0} : address;
                ended(client.on_frame(canopen::sdo_frame(0x585, in.PickValueInArray(commands), at, in.ConsumeIntegral<std::uint32_t>()),
                                      now, out));
                break;
            }
            default: {
                auto bytes = in.ConsumeBytes<std::uint8_t>(8);
                bytes.resize(8);
                ended(client.on_frame(canopen::data_frame(0x585, bytes), now, out));
            }
        }
    }
    if (client.busy()) {
        const auto end = client.on_deadline(client.deadline(), out);
        require(end.has_value(), "silence ends a transfer");
        ended(end);
    }
    return 0;
}
