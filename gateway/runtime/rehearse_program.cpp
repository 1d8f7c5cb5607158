// One thread runs the gateway and the door: it steps from event to event until the time of the computer is reached, serves the sockets, and
// sleeps until the next event.
#include "gateway/runtime/rehearse_program.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>

#include "gateway/core/text.hpp"
#include "gateway/doors/enip/server.hpp"
#include "gateway/doors/modbus/server.hpp"
#include "gateway/runtime/child_process.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/services/recipes/rehearsal_gateway.hpp"

namespace axisgate {
namespace {
constexpr Duration look_period = std::chrono::milliseconds(5);    ///< of the computer: whether the program has ended
constexpr Duration longest_sleep = std::chrono::milliseconds(1);  ///< of the computer
constexpr Duration longest_work = std::chrono::milliseconds(2);   ///< of the computer, between two looks at the sockets

/// The gateway as its doors see it.
class VirtualDoorPort final : public DoorPort {
public:
    explicit VirtualDoorPort(RehearsalGateway& gateway) : gateway_(gateway) {}
    [[nodiscard]] Instant now() const override { return gateway_.now(); }
    [[nodiscard]] const Image& image() const override { return gateway_.image(); }
    [[nodiscard]] const Catalogue* catalogue(AxisId axis) const override { return gateway_.engine().catalogue(axis); }
    void submit(Command command) override { gateway_.give(std::move(command)); }
    std::optional<Refusal> set_point(const SetPoint& set_point) override {
        return gateway_.engine().on_set_point(set_point, gateway_.now());
    }
    [[nodiscard]] DoorNumber attach(HotDoor& door) override { return gateway_.doors().attach(door); }
    void detach(HotDoor& door) override { gateway_.doors().detach(door); }
    void client_lost(const AuthorityClient& who, LossCause cause) override { gateway_.client_lost(who, cause); }

private:
    RehearsalGateway& gateway_;
};

class ProgramRun {
public:
    ProgramRun(RehearsalGateway& gateway, const ProgramRehearsalWish& wish) : gateway_(gateway), wish_(wish), began_(gateway.now()) {}

    /// Empty, or the fault of the computer or the program.
    [[nodiscard]] std::string play(const std::string& specimen) {
        static const std::array<std::string, 1> any_port{"127.0.0.1:0"};
        if (auto fault = door_.open(any_port); !fault.empty()) return fault;
        if (auto fault = enip_.open(any_port.front()); !fault.empty()) return fault;
        gateway_.doors().on_site(*gateway_.site());  // the device that EtherNet/IP shows names its ports
        std::string fault;
        ChildProcess program(wish_.command,
                             {{"AXISGATE_MODBUS", door_.addresses().front()},
                              {"AXISGATE_ENIP", enip_.addresses().front()},
                              {"AXISGATE_TIME_SCALE", fmt::format("{}", wish_.time_scale)},
                              {"AXISGATE_SPECIMEN", specimen}},
                             kept_output, fault);
        if (!fault.empty()) return fault;
        from_ = gateway_.now();
        at_ = monotonic_now();
        for (Instant looked = at_; gateway_.now() - began_ < wish_.limit;) {
            turn();
            if (monotonic_now() - looked < look_period) continue;
            looked = monotonic_now();
            if (program.look()) break;
        }
        const bool in_time = program.look();
        program.end();
        read_output(program.output());
        if (!in_time)
            return fmt::format("the program was not at its end after {:.0f} s", std::chrono::duration<double>(wish_.limit).count());
        if (program.code() == 0) return {};
        return last_line_.empty() ? fmt::format("the program ended with code {} and said nothing", program.code().value_or(-1))
                                  : last_line_;
    }
    [[nodiscard]] const std::string& step() const noexcept { return step_; }
    [[nodiscard]] Duration took() const { return gateway_.now() - began_; }

private:
    [[nodiscard]] enip::ServerSettings enip_settings() const {
        enip::ServerSettings s;
        s.io_port = 0;
        s.lease_s = std::chrono::duration_cast<std::chrono::seconds>(wish_.lease).count();
        s.owner_keeps_time = true;
        return s;
    }
    void turn() {
        const Instant began = monotonic_now();
        Instant now = began;
        while (gateway_.now() < wanted(now) && now - began < longest_work) {
            // The connections of EtherNet/IP send and time out at their own instants of the gateway's time.
            if (enip_.deadline() <= gateway_.now()) enip_.on_deadline();
            gateway_.step(std::min(wanted(now), enip_.deadline()));
            now = monotonic_now();
        }
        if (gateway_.now() < wanted(now) - std::chrono::milliseconds(20)) {  // too slow for this scale: its time is what it has got to
            from_ = gateway_.now();
            at_ = now;
        }
        if (io_.poll() > 0) return;
        const Instant next = std::min(gateway_.engine().wake_at(), enip_.deadline());
        const auto until =
            std::chrono::duration<double, std::nano>(next == never ? 1e9 : static_cast<double>((next - gateway_.now()).count()));
        const auto pause = Duration(static_cast<std::int64_t>(until.count() / wish_.time_scale));
        (void)io_.run_one_for(std::clamp(pause, Duration::zero(), longest_sleep));
    }
    [[nodiscard]] Instant wanted(Instant now) const {
        return from_ + Duration(static_cast<std::int64_t>(static_cast<double>((now - at_).count()) * wish_.time_scale));
    }
    void read_output(std::string_view output) {
        static constexpr std::string_view mark = "step: ";
        while (!output.empty()) {
            const auto end = std::min(output.find('\n'), output.size());
            const std::string line(trimmed(output.substr(0, end)));
            output.remove_prefix(std::min(end + 1, output.size()));
            if (line.starts_with(mark)) {
                step_ = line.substr(mark.size());
            } else if (!line.empty()) {
                last_line_ = line;
            }
        }
    }

    RehearsalGateway& gateway_;
    const ProgramRehearsalWish& wish_;
    boost::asio::io_context io_{1};
    boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
    VirtualDoorPort port_{gateway_};
    registers::RegisterImage registers_{port_, wish_.registers};
    modbus::Server door_{io_, port_, registers_, {}};
    enip::Server enip_{io_, port_, registers_, enip_settings()};
    Instant began_;          ///< virtual
    Instant from_{}, at_{};  ///< the same instant in virtual time and in that of the computer
    std::string step_, last_line_;
};
}  // namespace

RehearsedSpecimen rehearse_program(const Families& families, const ProgramRehearsalWish& wish, const std::string& specimen) {
    RehearsedSpecimen out;
    out.specimen = specimen;
    RehearsalGateway gateway(families, wish.site, wish.memory, wish.lease);
    const auto site = gateway.site();
    const auto all_online = [&] { return std::ranges::all_of(site->axis_ids, [&](AxisId axis) { return gateway.online(axis); }); };
    for (const Instant end = gateway.now() + RecipeRehearsal::start_limit; !all_online() && gateway.now() < end;)
        gateway.step(end);
    gateway.forget_warning();
    ProgramRun run(gateway, wish);
    out.text = run.play(specimen);
    out.passed = out.text.empty();
    if (!out.passed) out.step = run.step();
    out.event = gateway.last_warning();
    out.seconds = std::chrono::duration<double>(run.took()).count();
    return out;
}

}  // namespace axisgate
