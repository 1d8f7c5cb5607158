// The register port: reads of the register image as jobs of the hot thread, with the answer that a client of a register door would get now.
// Bounded by the hot thread's ring of jobs; further requests get an empty answer.
#pragma once

#include "gateway/registers/register_image.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/registers.hpp"

namespace axisgate {

class WarmRegisters final : public RegisterPort {
public:
    explicit WarmRegisters(const WarmThreads& threads) : threads_(threads) {}
    /// The hot thread's register image; must be set before the start.
    void use(registers::RegisterImage& image) { image_ = &image; }
    void read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                        std::function<void(std::optional<registers::RegisterRead>)> then) override {
        auto job = [this, unit, table, address, count, then](Engine&, Instant) {
            auto read = image_->read(unit, table, address, count);
            threads_.answer([then, read = std::move(read)]() mutable { then(std::move(read)); });
        };
        if (!image_ || !threads_.on_hot(std::move(job))) threads_.answer([then] { then(std::nullopt); });
    }

private:
    const WarmThreads& threads_;
    registers::RegisterImage* image_ = nullptr;  // of the hot thread, for its jobs
};

}  // namespace axisgate
