// `axisgate compare FAMILY --line URI` asks a drive on a line for everything that can be read without an effect, and prints the differences
// from its twin. The line is opened by this program alone: a gateway that serves it must be stopped before. The engine is never shut down
// here, because that would send stops to an axis that somebody else moves.
#include <fmt/core.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/json/serialize.hpp>
#include <csignal>

#include "gateway/core/line_uri.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/lines/make_line.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/command_tables.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/compare_report.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/services/parameters/line_sweep.hpp"
#include "gateway/services/parameters/memory_file.hpp"
#include "gateway/site/options.hpp"

namespace axisgate {
namespace {

/// The checked request of the command line.
struct SweepOrder {
    LineSweepWish wish;
    std::map<std::string, NonVolatile> memories;
};

std::string check_line(const CompareOptions& o, const Family& family, SweepOrder& order) {
    const auto uri = parse_line_uri(o.line_uri, family.default_bit_rate, family.default_format);
    if (!uri.good()) return "--line: " + uri.fault;
    using Kind = LineUri::Kind;
    if (uri.uri.kind == Kind::dds) return "--line: a line dds has axes of other gateways, which have no twin of their own";
    if (uri.uri.kind == Kind::twin)
        return "--line: twin is a line of `serve`; start a drive with `axisgate twin --line pty:PATH`, for example";
    const bool can = uri.uri.kind == Kind::can;
    if (!(can ? family.uses_can : family.uses_bytes))
        return fmt::format("--line: drives of {} do not have {}", family.name, can ? "CAN" : "a line of bytes");
    if (uri.uri.kind == Kind::serial || uri.uri.kind == Kind::pty) order.wish.bit_rate = uri.uri.serial.baud;
    return {};
}

std::string take_twin_options(const CompareOptions& o, const Catalogue& page, SweepOrder& order) {
    auto& options = order.wish.options;
    for (const auto& x : o.options) {
        const auto equals = x.find('=');
        if (equals == std::string::npos || equals == 0) return "--option: write NAME=VALUE";
        const std::string name = x.substr(0, equals), value = x.substr(equals + 1);
        if (name == "specimen") return "--option: use --specimen";
        if (auto wrong = check_option(page, {OptionOf::twin, OptionOf::drive, OptionOf::line}, name, value); !wrong.empty())
            return "--option: " + wrong;
        options[name] = value;
    }
    if (o.specimen.empty()) return {};
    options["specimen"] = o.specimen;
    const std::string wrong = check_specimen(o.specimen);
    return wrong.empty() ? "" : "--specimen: " + wrong;
}

std::string order_of(const CompareOptions& o, const FamilyEntry& entry, SweepOrder& order) {
    const Family& family = *entry.family;
    order.wish.family = o.family;
    order.wish.uri = o.line_uri;
    order.wish.channel = o.channel;
    order.wish.address = o.addresses.empty() ? std::string(family.factory_address) : o.addresses.front();
    if (!o.file.empty()) return "name a recording or --line, not both";
    if (o.addresses.size() > 1) return "--address: with --line one drive is compared at a time";
    if (auto wrong = family.check_address(order.wish.address); !wrong.empty()) return "--address: " + wrong;
    if (o.channel > entry.catalogue->most_channels())
        return fmt::format("--channel: a drive of {} has at most {}", family.name, entry.catalogue->most_channels());
    if (auto wrong = check_line(o, family, order); !wrong.empty()) return wrong;
    if (auto wrong = take_twin_options(o, *entry.catalogue, order); !wrong.empty()) return wrong;
    if (o.state_file.empty()) return {};
    std::string fault;
    const auto text = read_file(o.state_file, fault);
    if (!text) return fault;
    fault = memories_from_json(*text, order.memories);
    return fault.empty() ? "" : fmt::format("--state {}: {}", o.state_file, fault);
}

/// The line in real time, until the sweep is over or a signal ends it.
class SweptLine {
public:
    SweptLine(const Families& families, const SweepOrder& order)
        : gateway_(families, site_of(order.wish, families), {}, std::chrono::seconds(30), outside(families.find(order.wish.family))),
          sweep_(gateway_) {}

    /// Empty if a signal has ended it.
    std::optional<DriveComparisonInput> run(const NonVolatile& memory, Duration tolerance, std::string& fault) {
        boost::asio::signal_set signals(io_, SIGINT, SIGTERM);
        bool ended = false;
        signals.async_wait([&](const boost::system::error_code& ec, int) { ended = !ec; });
        boost::asio::steady_timer timer(io_);
        while (!sweep_.over() && !ended) {
            const Instant until =
                std::min({gateway_.engine().wake_at(), sweep_.deadline(), monotonic_now() + std::chrono::milliseconds(100)});
            timer.expires_at(std::chrono::steady_clock::time_point(
                std::chrono::duration_cast<std::chrono::steady_clock::duration>(until.time_since_epoch())));
            timer.async_wait([](const boost::system::error_code&) {});
            io_.run_one();
            while (io_.poll_one() > 0) {
            }
            gateway_.advance(monotonic_now());
            sweep_.turn();
        }
        fault = ended ? "it was interrupted" : sweep_.fault();
        return fault.empty() ? std::optional(sweep_.input(memory, tolerance)) : std::nullopt;
    }

private:
    RehearsalGateway::Outside outside(const FamilyEntry& entry) {
        RehearsalGateway::Outside out;
        out.make_line = [this, format = entry.family->default_format](const LineSpec& spec, const LineSetup& setup) {
            return make_real_line(spec.uri, setup, io_, format);
        };
        out.begin = monotonic_now();
        out.trace_frames = LineSweep::most_frames;
        return out;
    }

    boost::asio::io_context io_{1};
    RehearsalGateway gateway_;
    LineSweep sweep_;
};
}  // namespace

int command_compare_line(const CompareOptions& o) {
    const auto families = families_or_complain();
    if (!families) return exit_failed;
    const auto entry = family_or_complain(*families, o.family);
    if (!entry) return exit_usage;
    SweepOrder order;
    const auto refuse = [](const std::string& text) {
        complain(text);
        return exit_usage;
    };
    if (const std::string wrong = order_of(o, *entry, order); !wrong.empty()) return refuse(wrong);
    (void)std::signal(SIGPIPE, SIG_IGN);
    const auto& address = order.wish.address;
    std::string fault;
    SweptLine line(*families, order);
    const auto input = line.run(order.memories[address], std::chrono::milliseconds(o.tolerance_ms), fault);
    if (!input) return refuse(fmt::format("{}: {}", o.line_uri, fault));
    const DriveComparison result = compare_drive(*input);
    if (!o.adopt_file.empty() && result.fault.empty()) {
        order.memories[address] = result.adoption.memory;
        if (const std::string wrong = write_file(o.adopt_file, memories_to_json(order.memories)); !wrong.empty())
            return refuse("--adopt: " + wrong);
    }
    if (o.json)
        fmt::print("{}\n", boost::json::serialize(document_of(result)));
    else
        fmt::print("{}", sweep_text(result, o.adopt_file));
    if (!result.fault.empty()) return refuse(fmt::format("{}: {}", o.line_uri, result.fault));
    return result.differences() == 0 ? exit_good : exit_failed;
}

}  // namespace axisgate
