// Units 0, 1 and 255. Axis number n has 64 registers and 64 bits from (n-1)*64; holding and input registers are the same. Each axis has one
// rendered block, which is rendered again only if its picture has changed; after the first read of an axis number, reads allocate no
// memory.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gateway/engine/door.hpp"
#include "gateway/registers/parameter_channel.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/registers/unit_map.hpp"

namespace axisgate::registers {

class StandardMap final : public UnitMap {
public:
    StandardMap(const DoorPort& port, WordOrder order) : port_(port), order_(order) {}

    Verdict check_read(Table table, std::uint16_t address, std::uint16_t count) override;
    Verdict read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) override;
    Verdict read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) override;
    Verdict check_write(Table table, std::uint16_t address, std::uint16_t count) override;
    Verdict write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) override;
    /// `note` contains the axis number whose parameter channel started the exchange, and the number of the exchange.
    void on_own_result(std::uint32_t note, const Result& result) override;

    /// Sets registers 20 and 21: the reason of the axis' last refused write, and the number of refusals.
    void note_refusal(AxisId axis, Reason reason);

    [[nodiscard]] WordOrder word_order() const noexcept { return order_; }
    [[nodiscard]] AxisId axis_numbered(std::uint16_t number) const noexcept { return axis_at(number - 1u); }

    /// Number of renderings, for tests that unchanged axes cost nothing.
    [[nodiscard]] std::uint64_t renders() const noexcept { return renders_; }

private:
    struct Row {
        AxisId id = no_axis;         // the axis that the block shows; no_axis: none yet
        std::uint64_t revision = 0;  // of the axis' cell when the block was rendered
        std::uint16_t exchange = 0;  // number of the channel's exchange, so that the answer to an older exchange is not taken for that of a
                                     // newer one
        std::unique_ptr<ParameterChannel> channel;  // made at the first write
        std::uint16_t refusals = 0;                 // modulo 65536
        Reason refused = Reason::none;

        void belong_to(AxisId axis) {  // the channel is lost with the former axis; `exchange` continues to count
            id = axis;
            revision = 0;
            channel.reset();
            refusals = 0;
            refused = Reason::none;
        }
    };

    /// Updates the block of the axis with this index (number - 1) and returns it; nullptr if it is not configured.
    [[nodiscard]] std::uint8_t* block(std::uint32_t index);
    [[nodiscard]] AxisId axis_at(std::uint32_t index) const noexcept { return port_.image().by_number(index + 1); }
    static void put_refusals(const Row& row, std::uint8_t* block) noexcept;
    [[nodiscard]] Verdict no_such_axis(std::uint32_t index);
    [[nodiscard]] Verdict write_channel(std::uint32_t index, std::uint16_t offset, std::uint16_t count, const std::uint8_t* data,
                                        WritePlan& plan);

    const DoorPort& port_;
    WordOrder order_;
    std::uint32_t mapping_revision_ = 0;
    std::uint64_t renders_ = 0;
    std::vector<Row> rows_;             // by axis number - 1; grows to the highest requested number, at most 1024
    std::vector<std::uint8_t> blocks_;  // block_size bytes per row, so that a read across axes is one copy
};

}  // namespace axisgate::registers
