// The 64 registers and bits of one axis of the standard map, from address 0 of a unit of its own. The addresses are shifted; everything
// else is the standard map.
#pragma once

#include <cstdint>

#include "gateway/registers/standard_map.hpp"

namespace axisgate::registers {

class Cia402Block final : public UnitMap {
public:
    /// `number` is the axis number in the register map, 1..1024.
    Cia402Block(StandardMap& standard, std::uint16_t number)
        : standard_(standard), base_(static_cast<std::uint16_t>((number - 1) * registers_per_axis)) {}

    Verdict check_read(Table table, std::uint16_t address, std::uint16_t count) override {
        return outside(address, count) ? gap() : pass(standard_.check_read(table, at(address), count));
    }
    Verdict read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) override {
        return outside(address, count) ? gap() : pass(standard_.read_registers(table, at(address), count, now, out));
    }
    Verdict read_bits(Table table, std::uint16_t address, std::uint16_t count, std::uint8_t* out) override {
        return outside(address, count) ? gap() : pass(standard_.read_bits(table, at(address), count, out));
    }
    Verdict check_write(Table table, std::uint16_t address, std::uint16_t count) override {
        return outside(address, count) ? gap() : pass(standard_.check_write(table, at(address), count));
    }
    Verdict write(Table table, std::uint16_t address, std::uint16_t count, const std::uint8_t* data, WritePlan& plan) override {
        return outside(address, count) ? gap() : pass(standard_.write(table, at(address), count, data, plan));
    }
    /// The parameter channel is left out, because it is a sequence of requests and not an image.
    std::vector<MapValue> values(Table table, std::uint16_t address, std::uint16_t count, bool written) override {
        std::vector<MapValue> list;
        if (outside(address, count) || (written && table != Table::holding_registers)) return list;
        const auto number = static_cast<std::uint16_t>(base_ / registers_per_axis + 1);
        for (const RegisterRow& r : standard_registers()) {
            if (r.point.empty() || r.offset < address || r.offset + r.width() > address + count || (written && !r.writable)) continue;
            list.push_back(
                {r.offset, r.width(), false, standard_.word_order(), standard_.axis_numbered(number), axis_point_named(r.point)});
        }
        return list;
    }
    void on_own_result(std::uint32_t note, const Result& result) override {
        standard_.on_own_result(note, result);
        refused_ = standard_.take_refused();
    }

private:
    [[nodiscard]] static bool outside(std::uint16_t address, std::uint16_t count) noexcept {
        return address + std::uint32_t{count} > registers_per_axis;
    }
    [[nodiscard]] std::uint16_t at(std::uint16_t address) const noexcept { return static_cast<std::uint16_t>(base_ + address); }
    Verdict gap() { return refuse(Verdict::no_address, no_axis, Reason::unknown_point, "the block of an axis ends at register 63"); }
    Verdict pass(Verdict e) {
        refused_ = standard_.take_refused();
        return e;
    }

    StandardMap& standard_;
    std::uint16_t base_;
};

}  // namespace axisgate::registers
