// Fuzz target for the SDO server and its dictionary with a client that sends anything at any time. Laws: no call answers with more than a
// block, values keep their lengths and bounds, and after a pause a correct client is served.
#include "gateway/protocols/canopen/sdo_server.hpp"

#include <utility>

#include "gateway/protocols/canopen/dictionary.hpp"
#include "gateway/protocols/canopen/sdo_client.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using namespace axisgate::canopen;
using fuzz::require;

namespace {
Dictionary node() {
    Dictionary d;
    d.add({0x1008, 0}, {.type = DataType::visible_string, .access = EntryAccess::constant, .bytes = std::vector<std::uint8_t>(40, 'x')});
    d.add({0x1018, 1}, {.type = DataType::unsigned32, .access = EntryAccess::read_only});
    d.add({0x2000, 0}, {.type = DataType::domain, .most_bytes = 500});
    d.add({0x2001, 0}, {.type = DataType::domain});
    d.add({0x6060, 0}, {.type = DataType::integer8, .low = -1, .high = 10});
    d.add({0x6099, 1}, {.type = DataType::unsigned64, .low = 1, .high = 1000});
    return d;
}
/// One transfer without faults between them.
SdoEnd run(SdoClient& client, SdoServer& server, std::vector<Frame> requests, Instant now) {
    for (int i = 0; i < 10'000; ++i) {
        std::vector<Frame> answers, next;
        for (const Frame& f : requests)
            server.on_frame(f, now, answers);
        for (const Frame& f : answers) {
            if (auto end = client.on_frame(f, now, next)) {
                for (const Frame& last : next)
                    server.on_frame(last, now, answers);
                return *end;
            }
        }
        requests = std::move(next);
    }
    require(false, "a transfer without faults ends");
    return {};
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider in(data, size);
    Dictionary dictionary = node();
    SdoLimits limits;
    limits.most_bytes = 1000;
    limits.block_size = in.ConsumeIntegralInRange<std::uint8_t>(1, most_block_size);
    SdoServer server(5, dictionary, limits);
    std::vector<Frame> out;
    Instant now = time_zero;
    const Address places[]{{0x1008, 0}, {0x1018, 1}, {0x2000, 0}, {0x2001, 0}, {0x6060, 0}, {0x6099, 1}, {0x6099, 2}, {0x7000, 0}};
    const std::uint8_t commands[]{0x40, 0x60, 0x70, 0x2F, 0x23, 0x22, 0x21, 0x20, 0x00, 0x10,
                                  0x01, 0xA4, 0xA3, 0xA2, 0xA1, 0xC6, 0xC4, 0xD5, 0x80};
    while (in.remaining_bytes() > 0) {
        switch (in.ConsumeIntegralInRange<int>(0, 4)) {
            case 0:
                now += fuzz::any_step(in);
                server.on_deadline(now, out);
                break;
            case 1:
                server.on_frame(fuzz::any_frame(in), now, out);
                break;
            case 2: {
                auto bytes = in.ConsumeBytes<std::uint8_t>(8);
                bytes.resize(8);
                server.on_frame(data_frame(0x605, bytes), now, out);
                break;
            }
            default: {
                const std::uint8_t command = in.PickValueInArray(commands);
                const Address place = in.PickValueInArray(places);
                server.on_frame(sdo_frame(0x605, command, place, in.ConsumeIntegral<std::uint32_t>()), now, out);
            }
        }
        require(out.size() <= most_block_size, "no call answers with more than a block");
        for (const Frame& f : out)
            require(f.size == 8 && f.id == 0x585 && !f.extended, "an answer has eight bytes");
        out.clear();
        require(server.busy() != (server.deadline() == never), "a transfer has a deadline, and nothing else has");
    }
    for (const auto& [address, e] : dictionary.entries()) {
        const auto bytes = bytes_of(e.type);
        require(bytes ? e.bytes.size() == *bytes : e.bytes.size() <= limits.most_bytes, "a value has its length");
        require(e.most_bytes == 0 || e.bytes.size() <= e.most_bytes, "and its bound");
    }
    const auto mode = dictionary.integer({0x6060, 0});
    require(mode && *mode >= -1 && *mode <= 10, "a number stays in its bounds");
    require(dictionary.find({0x1008, 0})->bytes == std::vector<std::uint8_t>(40, 'x'), "a constant stays what it is");

    now += limits.patience;
    server.on_deadline(now, out);
    out.clear();
    for (const bool block : {false, true}) {
        SdoClient client(5, limits);
        const std::vector<std::uint8_t> value(size % 900, 0xA5);
        std::vector<Frame> requests;
        client.write({0x2001, 0}, value, now, requests, block);
        require(run(client, server, std::move(requests), now).done(), "an honest client can write");
        requests.clear();
        client.read({0x2001, 0}, now, requests, block);
        const auto end = run(client, server, std::move(requests), now);
        require(end.done() && end.data == value, "and reads what it wrote");
    }
    return 0;
}
