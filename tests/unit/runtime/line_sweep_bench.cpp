#include "tests/unit/runtime/line_sweep_bench.hpp"

#include <gtest/gtest.h>

#include "gateway/wire/specimen_twin.hpp"
#include "tests/unit/runtime/compare_bench.hpp"

namespace axisgate::compare_test {

/// The engine owns its line; the bench reaches the bus all the same.
class SweptLine::OnBus final : public Line {
public:
    explicit OnBus(std::shared_ptr<TwinBus> bus) : bus_(std::move(bus)) {}
    void open(LineEvents& events, Instant now) override { bus_->open(events, now); }
    void close() override { bus_->close(); }
    bool send(const Frame& frame, Priority priority, Instant now) override { return bus_->send(frame, priority, now); }
    [[nodiscard]] Instant deadline() const override { return bus_->deadline(); }
    void on_deadline(Instant now) override { bus_->on_deadline(now); }
    [[nodiscard]] LineStatus status(Instant now) const override { return bus_->status(now); }

private:
    std::shared_ptr<TwinBus> bus_;
};

SweptLine::SweptLine(Wish wish) : wish_(std::move(wish)) {
    const FamilyEntry family = families().find(wish_.family);
    TwinBusOptions o;
    o.kind = wish_.kind;
    o.bit_rate = wish_.kind == LineKind::can ? family.family->default_can_bit_rate : family.family->default_bit_rate;
    o.full_duplex = true;
    bus_ = std::make_shared<TwinBus>(o);
    TwinSetup t;
    t.address = wish_.address;
    t.kind = wish_.kind;
    t.bit_rate = o.bit_rate;
    t.options = wish_.drive_options;
    bus_->add(DriveId{0}, make_specimen(*family.family, *family.catalogue, t), wish_.memory, time_zero + std::chrono::seconds(1));
    LineSweepWish w;
    w.family = wish_.asked_family.empty() ? wish_.family : wish_.asked_family;
    w.uri = wish_.kind == LineKind::can ? "can:can0" : "tcp:127.0.0.1:1";
    w.address = wish_.asked_family.empty() ? wish_.address : std::string(families().find(w.family).family->factory_address);
    w.bit_rate = o.bit_rate;
    w.options = wish_.twin_options;
    RehearsalGateway::Outside outside;
    outside.make_line = [this](const LineSpec&, const LineSetup&) { return std::make_unique<OnBus>(bus_); };
    outside.begin = time_zero + std::chrono::seconds(20);  // the drive's start is over
    outside.trace_frames = LineSweep::most_frames;
    gateway_ = std::make_unique<RehearsalGateway>(families(), site_of(w, families()), SiteMemory{}, std::chrono::seconds(30), outside);
    sweep_ = std::make_unique<LineSweep>(*gateway_);
}

SweptLine::~SweptLine() = default;

void SweptLine::sweep(const std::function<void()>& each) {
    for (const Instant limit = gateway_->now() + std::chrono::hours(2); !sweep_->over();) {
        ASSERT_LT(gateway_->now(), limit);
        gateway_->step(std::min(sweep_->deadline(), limit));
        sweep_->turn();
        if (each) each();
    }
}

DriveComparison SweptLine::compared(Duration tolerance) const { return compare_drive(sweep_->input({}, tolerance)); }

void SweptLine::set_hand(const std::string& name, const Value& value) {
    EXPECT_EQ(bus_->set_hand(DriveId{0}, name, value, gateway_->now()), "");
}

void SweptLine::restart(const NonVolatile& memory) { bus_->restart(DriveId{0}, memory, gateway_->now()); }

std::size_t SweptLine::frames() const { return gateway_->engine().frame_log(gateway_->site()->line_ids.front())->next_sequence() - 1; }

}  // namespace axisgate::compare_test
