// A drive on a line of its own in virtual time, which is a twin with a memory and options that the comparison does not know, and the sweep
// of that line. The frames that the drive receives are kept.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/services/parameters/line_sweep.hpp"
#include "gateway/wire/twin_bus.hpp"

namespace axisgate::compare_test {

class SweptLine {
public:
    struct Wish {
        std::string family, address;
        LineKind kind = LineKind::can;
        std::map<std::string, std::string> drive_options{};  ///< of the drive alone: its freedoms
        NonVolatile memory{};                                ///< of the drive
        std::string asked_family{};                          ///< by the comparison; empty: the drive's
        std::map<std::string, std::string> twin_options{};   ///< given to the comparison
    };
    explicit SweptLine(Wish wish);
    ~SweptLine();

    /// `each`: called after each step of the gateway.
    void sweep(const std::function<void()>& each = {});
    [[nodiscard]] const LineSweep& result() const { return *sweep_; }
    [[nodiscard]] DriveComparison compared(Duration tolerance = std::chrono::milliseconds(20)) const;
    [[nodiscard]] Twin& drive() { return *bus_->twin(DriveId{0}); }
    [[nodiscard]] RehearsalGateway& gateway() { return *gateway_; }
    void set_hand(const std::string& name, const Value& value);
    /// Restarts the drive with this memory.
    void restart(const NonVolatile& memory);
    /// The number of questions of the sweep that were answered.
    [[nodiscard]] std::size_t frames() const;

private:
    class OnBus;
    Wish wish_;
    std::shared_ptr<TwinBus> bus_;
    std::unique_ptr<RehearsalGateway> gateway_;
    std::unique_ptr<LineSweep> sweep_;
};

}  // namespace axisgate::compare_test
