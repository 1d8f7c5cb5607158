// Fuzz target for PDO mappings of a node, and frames with them. Laws: a walk through a node ends, all fields are within 64 bits, bytes and
// values are equivalent, and values written to a node are read from it again.
#include "gateway/protocols/canopen/pdo.hpp"

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using namespace axisgate::canopen;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider in(data, size);
    const auto direction = in.ConsumeBool() ? PdoDirection::transmit : PdoDirection::receive;
    const auto number = in.ConsumeIntegralInRange<std::uint16_t>(1, most_pdos);
    PdoReader reader(direction, number);
    int steps = 0;
    while (const auto address = reader.next()) {
        require(++steps <= 70, "a walk ends");
        const std::size_t usual = address->index >= mapping_index(direction, 1) ? (address->sub == 0 ? 1 : 4)
                                  : address->sub == 1                           ? 4
                                  : address->sub == 2                           ? 1
                                                                                : 2;
        switch (in.ConsumeIntegralInRange<int>(0, 7)) {
            case 0:
                reader.on_refused(static_cast<Abort>(in.ConsumeIntegral<std::uint32_t>()));
                break;
            case 1:
                reader.on_value(in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(0, 9)));
                break;
            default: {
                auto bytes = in.ConsumeBytes<std::uint8_t>(usual);
                bytes.resize(usual);
                reader.on_value(bytes);
            }
        }
    }
    if (reader.fault() != Abort::none) return 0;
    const Pdo pdo = reader.pdo();
    require(fault_of(pdo.mapping) == Abort::none && bits_of(pdo.mapping) <= pdo_bits, "what was read is a mapping");
    for (const auto& e : pdo.mapping)
        require(mapped_entry(mapping_word(e)) == e, "a word is its entry");

    const auto bytes = in.ConsumeBytes<std::uint8_t>(8);
    std::vector<std::uint64_t> values;
    const auto length = unpack(pdo.mapping, bytes, values);
    const std::size_t need = (bits_of(pdo.mapping) + 7) / 8;
    require((length == PdoLength::shorter) == (bytes.size() < need), "a frame is too short when bytes are missing");
    if (length != PdoLength::shorter) {
        require(values.size() == pdo.mapping.size(), "every entry has a value");
        const auto again = pack(pdo.mapping, values);
        require(again && again->size() == need, "values make a frame of that length");
        std::vector<std::uint64_t> twice;
        require(unpack(pdo.mapping, *again, twice) == PdoLength::fits && twice == values, "and the same values");
    }

    Dictionary node;
    const std::uint16_t settings = settings_index(direction, number), mapping = mapping_index(direction, number);
    node.add({settings, 1}, {.type = DataType::unsigned32});
    node.add({settings, 2}, {.type = DataType::unsigned8});
    node.add({settings, 3}, {.type = DataType::unsigned16});
    node.add({settings, 5}, {.type = DataType::unsigned16});
    node.add({mapping, 0}, {.type = DataType::unsigned8});
    for (std::uint8_t i = 1; i <= most_mapped; ++i)
        node.add({mapping, i}, {.type = DataType::unsigned32});
    for (const auto& w : writes_of(pdo))
        require(node.write(w.address, w.bytes, true) == Abort::none, "a node takes the writes");
    Abort fault = Abort::none;
    const auto back = pdo_of(node, direction, number, fault);
    require(back.has_value(), "and has the PDO");
    Pdo expected = pdo;
    if (direction == PdoDirection::receive) expected.settings.inhibit_100us = 0;  // a receive PDO is not asked for it
    require(*back == expected, "as it was");
    return 0;
}
