// Makes a copy of the database, then the archive with it and the host's files, then checks the archive, then renames it. The places of
// members are those of this host, never those in a backup.
#include "gateway/runtime/backup_plan.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <ctime>
#include <filesystem>

#include "gateway/runtime/door_dds.hpp"
#include "gateway/runtime/door_http.hpp"
#include "gateway/runtime/sealed.hpp"
#include "gateway/store/backup.hpp"
#include "gateway/store/files.hpp"

namespace axisgate {
namespace {
using Kind = BackupFault::Kind;

tl::unexpected<BackupFault> of_store(const StoreError& e) {
    const bool reading =
        e.kind == StoreError::Kind::corrupt || e.kind == StoreError::Kind::not_found || e.kind == StoreError::Kind::not_ours;
    return backup_fault(reading ? Kind::cannot_read : Kind::cannot_write, e.text);
}

std::string name_of_host() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

BackupResult<> write_archive(const std::string& file, const BackupOrder& order, const BackupContents& contents,
                             const std::vector<BackupMember>& members) {
    auto to = FileSink::create(file);
    if (!to) return tl::unexpected(to.error());
    if (order.passphrase.empty()) {
        if (auto r = write_backup(**to, contents, members); !r) return r;
        return (*to)->finish();
    }
    auto sealer = Sealer::begin(**to, order.passphrase);
    if (!sealer) return tl::unexpected(sealer.error());
    if (auto r = write_backup(**sealer, contents, members); !r) return r;
    if (auto r = (*sealer)->finish(); !r) return r;
    return (*to)->finish();
}
}  // namespace

BackupPlan backup_plan(const Config& config, const std::string& config_file) {
    return {config.data_dir, config_file == "-" ? "" : config_file, config.of<HttpSettings>().tls_cert, config.of<HttpSettings>().tls_key,
            config.of<DdsSettings>().security};
}

std::optional<std::string> place_of(std::string_view member, const BackupPlan& plan) {
    const auto or_none = [](const std::string& path) { return path.empty() ? std::nullopt : std::optional(path); };
    if (member == configuration_member) return or_none(plan.config_file);
    if (member == "tls-cert.pem") return or_none(plan.tls_cert);
    if (member == "tls-key.pem") return or_none(plan.tls_key);
    if (member.starts_with("http-")) return fmt::format("{}/{}", plan.data_dir, member);
    if (member.starts_with("dds/") && !plan.dds_dir.empty()) return fmt::format("{}/{}", plan.dds_dir, member.substr(4));
    return std::nullopt;
}

BackupResult<BackupContents> make_backup(const BackupPlan& plan, const BackupOrder& order, const std::string& target) {
    if (const auto fits = check_backup_target(plan.data_dir, target); !fits) return of_store(fits.error());
    if (!order.passphrase.empty()) {
        if (std::string fault = passphrase_fault(order.passphrase); !fault.empty())
            return backup_fault(Kind::passphrase_unfit, std::move(fault));
    }
    static std::atomic<unsigned> count{0};  // two simultaneous backups to one name must not share their unfinished files
    const std::string part = fmt::format("{}.{}-{}", target, ::getpid(), ++count);
    const std::string database = part + ".db.part", archive = part + ".part";

    BackupContents contents{AXISGATE_VERSION, name_of_host(), std::time(nullptr), {}, {}};
    contents.left_out.emplace_back("recordings", "they stay in the data directory: fetch what is wanted with GET /recorder/recordings");
    if (plan.config_file.empty()) contents.left_out.emplace_back(configuration_member, "there is no configuration file");
    std::vector<BackupMember> members{{std::string(database_member), database}};
    std::error_code ec;
    for (const auto name : backup_members) {
        const auto place = place_of(name, plan);
        if (!place) continue;
        if (name.starts_with("http-") && !std::filesystem::exists(*place, ec)) continue;  // there is no such certificate
        if (name.ends_with("key.pem") && !order.keys) {
            contents.left_out.emplace_back(name,
                                           "private keys go into a backup that is sealed with a passphrase, or made by `axisgate backup`");
            continue;
        }
        members.push_back({std::string(name), *place});
    }
    const auto made = [&]() -> BackupResult<BackupContents> {
        if (const auto copied = backup_database(plan.data_dir, database); !copied) return of_store(copied.error());
        if (auto r = write_archive(archive, order, contents, members); !r) return tl::unexpected(r.error());
        auto good = open_backup(archive, order.passphrase, {});
        if (!good) return good;
        const auto path = std::filesystem::absolute(target, ec);
        if (const auto named = files::rename(archive, path.string(), path.parent_path().string()); !named) return of_store(named.error());
        return good;
    }();
    files::remove_database(database);
    if (!made) std::filesystem::remove(archive, ec);
    return made;
}

}  // namespace axisgate
