// Collects the data for support in one archive without secrets: files, the database (read-only), pages of the gateway on this machine.
// Bounds: 10,000 events, the last 1 MiB of the log; for pages those of own_page.hpp.
#include "gateway/runtime/bundle.hpp"

#include <fmt/core.h>
#include <sys/utsname.h>

#include <algorithm>
#include <boost/json/serialize.hpp>
#include <filesystem>
#include <fstream>
#include <tuple>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/core/text.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/own_page.hpp"
#include "gateway/runtime/scrub.hpp"
#include "gateway/runtime/tar.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/store/reader.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t most_events = 10'000, most_log = 1u << 20;

/// The last bytes of a file; files of /proc have no length and are read from the beginning.
std::string tail_of_file(const std::string& path, std::size_t most = most_log) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(0, std::ios::end);
    const auto size = static_cast<std::int64_t>(file.tellg());
    file.clear();
    file.seekg(std::max<std::int64_t>(0, size - static_cast<std::int64_t>(most)));
    std::string text(most, '\0');
    file.read(text.data(), static_cast<std::streamsize>(most));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
    return text;
}

class Bundle {
public:
    Bundle(const ConfigSources& sources, const Config& config) : sources_(sources), config_(config) {}

    std::string make() {
        versions();
        configuration();
        machine();
        database();
        log();
        pages();
        readme();
        return std::move(tar_).finish();
    }

private:
    void add(std::string_view name, std::string_view content, std::string_view what) {
        tar_.add(fmt::format("axisgate-bundle/{}", name), scrub(content), at_);
        contents_ += fmt::format("{:<24} {}\n", name, what);
    }
    void missing(std::string_view name, std::string_view why) { missing_ += fmt::format("{:<24} {}\n", name, why); }

    void versions() {
        utsname u{};
        (void)::uname(&u);
        std::string s = fmt::format("axisgate {}\nmade {}\nkernel {} {} {}\n", AXISGATE_VERSION, format_time(unix_now_ns()), u.sysname,
                                    u.release, u.machine);
        s += tail_of_file("/etc/os-release");
        add("version.txt", s, "program, time, kernel, distribution");
    }
    void configuration() {
        std::string s = sources_.file_text ? fmt::format("# {}\n{}\n", sources_.file_name, *sources_.file_text) : "# no file was given\n";
        for (const auto& o : sources_.overrides)
            s += fmt::format("# --set {}\n", o);
        for (const auto& e : sources_.environment)
            s += fmt::format("# environment: {}\n", e);
        add("axisgate.toml", s, "the configuration, with what overrides it");
    }
    void machine() {
        std::string s;
        for (const auto* path : {"/proc/uptime", "/proc/loadavg", "/proc/meminfo", "/proc/net/dev", "/proc/interrupts"})
            s += fmt::format("== {}\n{}\n", path, tail_of_file(path, 64u << 10));
        for (const auto* folder : {"/dev/serial/by-id", "/sys/class/net", "/sys/class/tty"}) {
            s += fmt::format("== {}\n", folder);
            std::error_code ec;
            std::vector<std::string> names;
            for (const auto& entry : fs::directory_iterator(folder, ec))
                names.push_back(entry.path().filename().string());
            std::ranges::sort(names);
            for (const auto& n : names)
                s += n + "\n";
        }
        std::error_code ec;
        if (const auto space = fs::space(config_.data_dir, ec); !ec)
            s += fmt::format("== disk of {}\n{} of {} bytes free\n", config_.data_dir, space.available, space.capacity);
        add("machine.txt", s, "load, memory, network, serial ports, free disk");
    }
    void database() {
        StoreOptions options;
        options.directory = config_.data_dir;
        if (const auto migrations = migrations_among(all_assets())) options.migrations = *migrations;
        auto reader = StoreReader::open(options);
        if (!reader) return missing("database.txt", reader.error().text);
        const auto checked = (*reader)->check();
        std::string s = checked ? "the integrity check found nothing\n" : "the integrity check: " + checked.error().text + "\n";
        if (const auto history = (*reader)->site_history(100)) {
            for (const auto& r : *history)
                s += fmt::format("site revision {} of {} by {}\n", r.revision, format_time(r.at_unix_ns), r.who);
        }
        for (const auto& name : {"axisgate.db", "axisgate.db-wal"}) {
            std::error_code ec;
            if (const auto size = fs::file_size(fs::path(config_.data_dir) / name, ec); !ec) s += fmt::format("{}: {} bytes\n", name, size);
        }
        add("database.txt", s, "integrity, size, history of the site");
        if (const auto site = (*reader)->load_site(); site && *site) add("site.json", (*site)->text, "lines, drives, axes, mappings");
        parameters(**reader);
        events(**reader);
    }
    void events(StoreReader& reader) {
        std::string lines;
        EventFilter filter;
        filter.limit = 1000;
        for (std::size_t n = 0; n < most_events; n += filter.limit) {
            const auto page = reader.events(filter);
            if (!page || page->empty()) break;
            filter.before_id = page->front().id;
            for (const auto& e : *page) {
                lines += boost::json::serialize(event_document(e)) + "\n";
                filter.before_id = std::min(filter.before_id, e.id);
            }
        }
        add("events.jsonl", lines, "the newest 10,000 events, one a line, in pages of 1,000");
    }
    void parameters(StoreReader& reader) {
        std::string lines = "axis,parameter,value,at\n";
        const auto axes = reader.axes();
        if (!axes) return;
        for (const auto& a : *axes) {
            const auto stored = reader.stored(a.name);
            if (!stored) continue;
            for (const auto& p : *stored)
                lines +=
                    fmt::format("{},{},{},{}\n", a.name, p.parameter, boost::json::serialize(to_json(p.value)), format_time(p.at_unix_ns));
        }
        add("parameters.csv", lines, "the newest acknowledged write of each parameter");
    }
    void log() {
        if (config_.log_file.empty()) return missing("axisgate.log", "the log goes to standard error: see journalctl -u axisgate");
        add("axisgate.log", tail_of_file(config_.log_file), "the last 1 MiB of the log");
    }
    void pages() {
        for (const auto& [name, path, what] : {std::tuple{"about.json", "/api/v1/about", "doors, versions, families"},
                                               {"readyz.json", "/readyz", "what is not as it should be"},
                                               {"metrics.txt", "/metrics", "every figure"},
                                               {"lines.json", "/api/v1/lines", "lines and their state"},
                                               {"drives.json", "/api/v1/drives", "drives and who serves them"},
                                               {"axes.json", "/api/v1/axes", "axes as they are"},
                                               {"alarms.json", "/api/v1/alarms", "the list of alarms"},
                                               {"modbus.json", "/api/v1/modbus", "Modbus clients and locks"}}) {
            const OwnPage page = own_page(config_, path);
            page.fault.empty() ? add(name, page.body, what) : missing(name, fmt::format("{}: {}", path, page.fault));
        }
    }
    void readme() {
        const std::string contents = contents_;
        add("README.txt",
            fmt::format("Support bundle of axisgate {}, made {}.\n\nIn it:\n\n{}\nNot in it:\n\n{}{:<24} {}\n\nPasswords, tokens, sign-in "
                        "codes and keys "
                        "were taken out of every text (\"(removed)\"). Names of users, axes and machines are there.\n",
                        AXISGATE_VERSION, format_time(at_ * 1'000'000'000), contents, missing_, "users, tokens, keys", "never"),
            "this list");
    }

    const ConfigSources& sources_;
    const Config& config_;
    std::int64_t at_ = unix_now_ns() / 1'000'000'000;
    Tar tar_;
    std::string contents_, missing_;
};
}  // namespace

std::string make_bundle(const ConfigSources& sources, const Config& config) { return Bundle(sources, config).make(); }

}  // namespace axisgate
