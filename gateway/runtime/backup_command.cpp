// The commands `axisgate backup` and `axisgate restore`: the whole gateway as one file, and back to its places on this host. A restore
// replaces nothing before the whole backup was checked and every new file lies beside its place, and uses paths of a backup only with
// --with-config.
#include <fmt/core.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/runtime/backup_plan.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/commands.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/restore_note.hpp"
#include "gateway/runtime/sealed.hpp"
#include "gateway/store/backup.hpp"
#include "gateway/store/files.hpp"
#include "gateway/store/migrate.hpp"

namespace axisgate {
namespace {
namespace fs = std::filesystem;

/// The content of --passphrase-file, without its line end; empty: the fault was reported.
std::optional<std::string> passphrase_in(const std::string& file) {
    if (file.empty()) return std::string();
    std::string fault;
    auto text = read_file(file, fault, most_passphrase_bytes + 2);
    if (!text) {
        complain(fault);
        return std::nullopt;
    }
    while (text->ends_with('\n') || text->ends_with('\r'))
        text->pop_back();
    if (!text->empty()) return text;
    complain(fmt::format("{} is empty: write the passphrase into it", file));
    return std::nullopt;
}

/// Reports that `what` has failed.
int failed(const BackupFault& f, const std::string& what) {
    switch (f.kind) {
        case BackupFault::Kind::cannot_read:
        case BackupFault::Kind::cannot_write:
            complain(f.text);
            break;
        case BackupFault::Kind::passphrase_unfit:
            complain(f.text + ": write another one into the file of --passphrase-file");
            break;
        case BackupFault::Kind::passphrase_needed:
        case BackupFault::Kind::passphrase_wrong:
            complain(fmt::format("{}: {}; give the file with it by --passphrase-file", what, f.text));
            break;
        default:
            complain(fmt::format("{}: {}. Name a whole backup of this or an older axisgate", what, f.text));
    }
    return exit_failed;
}

/// A temporary folder with the content of a backup, removed by the destructor.
class Spread {
public:
    explicit Spread(const std::string& data_dir) : folder_(fmt::format("{}/restore-check-{}", data_dir, ::getpid())) { clear(); }
    ~Spread() { clear(); }
    Spread(const Spread&) = delete;
    Spread& operator=(const Spread&) = delete;
    [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

private:
    void clear() {
        std::error_code ec;
        fs::remove_all(folder_, ec);
    }
    std::string folder_;
};

/// Files of the host that are replaced together: first each is put beside its place, then all are moved.
class Places {
public:
    ~Places() {
        std::error_code ec;
        for (const auto& w : waiting_)
            fs::remove(w.beside, ec);
    }
    /// Empty, or the reason why it is impossible. An identical existing file is kept.
    [[nodiscard]] std::string prepare(const std::string& from, const std::string& place, const std::string& owner_of) {
        std::string fault, ignored;
        const auto bytes = read_file(from, fault, most_file_bytes);
        if (!bytes) return fault;
        struct stat st {};
        const bool there = ::stat(place.c_str(), &st) == 0;
        if (there && read_file(place, ignored, most_file_bytes) == bytes) return {};
        std::error_code ec;
        const auto folder = fs::path(place).parent_path();
        if (!folder.empty() && !fs::exists(folder, ec)) {
            if (::mkdir(folder.c_str(), 0700) != 0) return fmt::format("cannot make the folder {}", folder.string());
            give(folder.string(), owner_of);
        }
        const std::string beside = place + ".restored";
        if (const std::string why = write_secret(beside, *bytes); !why.empty()) return fmt::format("cannot write {}: {}", beside, why);
        waiting_.push_back({beside, place});
        if (!there) {
            give(beside, owner_of);
            return {};
        }
        // The mode of the existing file is kept: the configuration is readable by all, a key is not.
        if (::chmod(beside.c_str(), st.st_mode & 07777) != 0) return fmt::format("cannot set the mode of {}", beside);
        if (::geteuid() == 0) {
            [[maybe_unused]] const int r = ::chown(beside.c_str(), st.st_uid, st.st_gid);
        }
        return {};
    }
    /// Moves each file into its place; an existing file is kept beside it under the first free number. Failures are reported.
    [[nodiscard]] bool take() {
        bool good = true;
        for (const auto& w : waiting_) {
            std::error_code ec;
            std::string aside;
            for (int n = 1; fs::exists(w.place, ec) && n <= 99 && aside.empty(); ++n) {
                const std::string name = fmt::format("{}.replaced-{}", w.place, n);
                if (!fs::exists(name, ec)) aside = name;
            }
            if (!aside.empty()) fs::rename(w.place, aside, ec);
            if (!ec) fs::rename(w.beside, w.place, ec);
            if (ec) complain(fmt::format("{} could not be put in its place: {}; restore again", w.place, ec.message()));
            good = good && !ec;
            if (!ec) fmt::print("{}{}\n", w.place, aside.empty() ? "" : "; what was there is kept as " + aside);
        }
        waiting_.clear();
        return good;
    }

private:
    static constexpr std::size_t most_file_bytes = 1U << 20;
    struct Waiting {
        std::string beside, place;
    };
    /// A new file belongs to the service like the data directory, so that `sudo axisgate restore` does not lock it out.
    static void give(const std::string& path, const std::string& owner_of) {
        struct stat st {};
        if (::geteuid() == 0 && ::stat(owner_of.c_str(), &st) == 0) {
            [[maybe_unused]] const int r = ::chown(path.c_str(), st.st_uid, st.st_gid);
        }
    }
    std::vector<Waiting> waiting_;
};

/// The name of the person who restores: the user behind sudo, or the user of this process.
std::string who_restores() {
    const char* name = std::getenv("SUDO_USER");
    if (!name || !*name) {
        const passwd* entry = ::getpwuid(::getuid());
        name = entry ? entry->pw_name : "";
    }
    return fmt::format("axisgate restore {}", *name ? std::string(name) : fmt::format("uid {}", ::getuid()));
}

/// Links are followed.
bool lies_below(const fs::path& place, const fs::path& folder) {
    std::error_code ec;
    const auto real = fs::weakly_canonical(fs::absolute(place, ec), ec), base = fs::weakly_canonical(fs::absolute(folder, ec), ec);
    if (ec || base.empty()) return false;
    const auto [in_base, in_real] = std::mismatch(base.begin(), base.end(), real.begin(), real.end());
    return in_base == base.end() && in_real != real.end();
}

/// Empty, or the reason why the bytes do not fit the member's name: certificates, keys and signed documents are text in PEM or MIME form.
std::string wrong_form(std::string_view member, const std::string& bytes) {
    const bool text =
        std::ranges::all_of(bytes, [](unsigned char c) { return (c >= 0x20 && c < 0x7F) || c == '\n' || c == '\r' || c == '\t'; });
    const bool is_pem = bytes.starts_with("-----BEGIN ") || bytes.find("\n-----BEGIN ") != std::string::npos;
    if (member.ends_with(".pem") && !(text && is_pem && bytes.find("-----END ") != std::string::npos)) return "it is no PEM";
    if (member.ends_with(".p7s") && !(text && bytes.starts_with("MIME-Version: "))) return "it is no signed document";
    return {};
}

/// `shown` is the name of the file for messages.
int put_database(const std::string& file, const std::string& shown, const Config& config, std::string& kept) {
    StoreOptions options;
    options.directory = config.data_dir;
    const auto migrations = migrations_among(all_assets());
    if (!migrations) {
        complain(migrations.error().text);
        return exit_failed;
    }
    options.migrations = *migrations;
    const auto done = restore_database(file, options);
    if (!done) {
        std::string text = done.error().text;
        for (std::size_t at = text.find(file); file != shown && at != std::string::npos; at = text.find(file, at + shown.size()))
            text.replace(at, file.size(), shown);
        complain(text);
        return exit_failed;
    }
    kept = done->kept;
    const RestoreNote note{who_restores(), unix_now_ns(), done->replaced_site_revision, done->site_revision};
    if (const std::string why = leave_restore_note(config.data_dir, note); !why.empty()) complain(why);
    return exit_good;
}

void print_restored(const Config& config, const std::string& kept) {
    fmt::print("restored into {}{}\n", config.data_dir, kept.empty() ? "" : "; the database that was there is kept as " + kept);
    fmt::print("{}\n", restore_warning);
}

/// The configuration that applies from now on: this host's, or that of the backup as this host would read it.
bool configuration_of(const RestoreOptions& options, const ConfigSources& sources, const std::string& folder, Config& config) {
    if (!options.with_config) return true;
    std::string fault;
    auto text = read_file(fmt::format("{}/{}", folder, configuration_member), fault, 1U << 20);
    if (!text) {
        complain("there is no configuration in this backup: restore it without --with-config");
        return false;
    }
    ConfigSources taken = sources;
    taken.file_text = std::move(*text);
    taken.file_name = std::string(configuration_member) + " of the backup";
    std::vector<ConfigFault> faults;
    config = read_config(taken, faults);
    for (const auto& f : faults)
        complain(f);
    return faults.empty();
}

/// The configuration of a backup determines where files are written, possibly as root. Places outside the folder of the configuration are
/// shown, and used only after a confirmation.
bool may_take_places(const RestoreOptions& options, const ConfigSources& sources, const BackupContents& contents, const Config& config,
                     const std::string& own_data) {
    std::error_code ec;
    const auto folder = fs::absolute(sources.file_name, ec).parent_path();
    std::vector<std::string> outside;
    const auto look = [&](std::string_view what, const std::string& place) {
        if (!lies_below(place, folder) && !lies_below(place, own_data) && !fs::equivalent(place, own_data, ec))
            outside.push_back(fmt::format("{} -> {}", what, place));
    };
    look("database", config.data_dir);
    const BackupPlan there = backup_plan(config, sources.file_name);
    for (const auto& member : contents.members) {
        const auto place = member == database_member || member == configuration_member ? std::nullopt : place_of(member, there);
        if (place && !place->starts_with(config.data_dir + "/")) look(member, *place);
    }
    for (const auto& place : outside)
        fmt::print("outside the folder of the configuration: {}\n", place);
    if (outside.empty() || options.confirm_places) return true;
    complain(
        fmt::format("{} not restored, nothing was replaced: its configuration names places outside {}; if they are right, restore "
                    "again with --confirm-places",
                    options.file, folder.string()));
    return false;
}

/// Puts everything except the database beside its place; empty, or the fault.
std::string prepare_files(const BackupContents& contents, const std::string& folder, const BackupPlan& plan, const Config& config,
                          Places& places, std::vector<std::string>& not_taken) {
    for (const auto& member : contents.members) {
        if (member == database_member) continue;
        const auto place = place_of(member, plan);
        if (!place) {
            not_taken.push_back(member);
            continue;
        }
        const std::string from = fmt::format("{}/{}", folder, member);
        std::string fault;
        if (const auto bytes = read_file(from, fault, 1U << 20)) {
            if (const std::string why = wrong_form(member, *bytes); !why.empty())
                fault = fmt::format("{}: {}", member, why);
            else
                fault = places.prepare(from, *place, config.data_dir);
        }
        if (!fault.empty()) return fault;
    }
    return {};
}
}  // namespace

int command_backup(const Config& config, const std::string& config_file, const std::string& file, const std::string& passphrase_file) {
    const auto passphrase = passphrase_in(passphrase_file);
    if (!passphrase) return exit_usage;
    const auto made = make_backup(backup_plan(config, config_file), {*passphrase, true}, file);
    if (!made) return failed(made.error(), "no backup made to " + file);
    fmt::print("{}\n", file);
    for (const auto& [what, why] : made->left_out)
        fmt::print("left out: {}: {}\n", what, why);
    return exit_good;
}

int command_restore(Config config, const ConfigSources& sources, const RestoreOptions& options) {
    const std::string& file = options.file;
    if (options.with_config && sources.file_name.empty()) {
        complain("--with-config puts the configuration of the backup in the place of the file of --config: name it");
        return exit_usage;
    }
    const auto passphrase = passphrase_in(options.passphrase_file);
    if (!passphrase) return exit_usage;
    std::error_code ec;
    std::string kept;
    if (!fs::exists(file, ec) || backup_form_of_file(file) == BackupForm::database || backup_form_of_file(file) == BackupForm::none) {
        // A plain database, or a file for which the store has the better message.
        if (options.with_config) {
            complain(fmt::format("{} is a database alone: there is no configuration in it", file));
            return exit_usage;
        }
        if (const int code = put_database(file, file, config, kept); code != exit_good) return code;
        print_restored(config, kept);
        return exit_good;
    }
    if (const auto made = files::make_directory(config.data_dir); !made) {
        complain(made.error().text);
        return exit_failed;
    }
    const Spread spread(config.data_dir);
    const auto in_it = open_backup(file, *passphrase, spread.folder());
    if (!in_it) return failed(in_it.error(), file + " not restored, nothing was replaced");
    const std::string own_data = config.data_dir;
    if (!configuration_of(options, sources, spread.folder(), config)) return exit_failed;
    if (options.with_config && !may_take_places(options, sources, *in_it, config, own_data)) return exit_failed;
    if (const auto made = files::make_directory(config.data_dir); !made) {  // which may be another one now
        complain(made.error().text);
        return exit_failed;
    }
    const BackupPlan plan = backup_plan(config, options.with_config ? sources.file_name : "");
    Places places;
    std::vector<std::string> not_taken;
    if (const std::string fault = prepare_files(*in_it, spread.folder(), plan, config, places, not_taken); !fault.empty()) {
        complain(fmt::format("{} not restored, nothing was replaced: {}", file, fault));
        return exit_failed;
    }
    const int code = put_database(fmt::format("{}/{}", spread.folder(), database_member), file, config, kept);
    if (code != exit_good) return code;
    print_restored(config, kept);
    const bool good = places.take();
    for (const auto& member : not_taken)
        fmt::print("not taken: {}: {}\n", member,
                   member == configuration_member ? "--with-config takes it" : "this host's configuration names no place for it");
    for (const auto& [what, why] : in_it->left_out)
        fmt::print("not in it: {}: {}\n", what, why);
    return good ? exit_good : exit_failed;
}

}  // namespace axisgate
