// WarmGateway, second part: snapshots, the site's history and its staged changes, registers as the Modbus door shows them, backups.
// In: calls, the end of a trial. Out: callbacks. Reads of the database are local and short. Never writes by itself: the cold thread does.
#include <fmt/core.h>

#include <boost/asio/post.hpp>
#include <boost/json/serialize.hpp>
#include <filesystem>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/runtime/site_names.hpp"
#include "gateway/runtime/site_trial.hpp"
#include "gateway/runtime/waiting_backup.hpp"
#include "gateway/runtime/warm_gateway.hpp"

namespace axisgate {
namespace {
constexpr std::int64_t try_again_s = 5;                 // a roll back that could not be stored is tried again
constexpr std::size_t most_backup_bytes = 64ull << 20;  // a larger one is made with `axisgate backup`
std::string text_of(const Origin& origin) { return origin.who ? *origin.who : origin.text(); }
}  // namespace

// --- snapshots and history ------------------------------------------------------------------------------------------

std::vector<SnapshotInfo> WarmGateway::snapshots(const std::string& axis) const {
    return reader_->snapshots(axis).value_or(std::vector<SnapshotInfo>());
}

std::optional<AxisSnapshot> WarmGateway::snapshot(const std::string& axis, std::uint32_t n) const {
    return reader_->snapshot(axis, n).value_or(std::nullopt);
}

void WarmGateway::save_snapshot(AxisSnapshot snapshot, std::string axis, std::function<void(std::uint32_t n, std::string fault)> then) {
    cold_.run([this, s = std::move(snapshot), axis = std::move(axis), then = std::move(then)](Store& store) {
        const auto n = store.save_snapshot(axis, s.name, s.comment, s.who, s.at_unix_ns, s.parameters);
        boost::asio::post(io_, [then, n = n ? *n : 0, fault = n ? std::string() : n.error().text] { then(n, fault); });
    });
}

void WarmGateway::delete_snapshot(std::string axis, std::uint32_t n, std::function<void(std::string fault)> then) {
    cold_.run([this, axis = std::move(axis), n, then = std::move(then)](Store& store) {
        const auto done = store.delete_snapshot(axis, n);
        boost::asio::post(io_, [then, fault = done ? std::string() : done.error().text] { then(fault); });
    });
}

std::vector<SiteRevision> WarmGateway::site_history(std::size_t limit, std::uint64_t before) const {
    return reader_->site_history(limit, before).value_or(std::vector<SiteRevision>());
}

std::optional<SiteRevision> WarmGateway::site_revision(std::uint64_t revision) const {
    return reader_->site(revision).value_or(std::nullopt);
}

// --- staged changes of the site -------------------------------------------------------------------------------------

void WarmGateway::tell_site(std::string text, const Origin& origin, Severity severity) {
    Event e;
    e.kind = "site";
    e.severity = severity;
    e.text = std::move(text);
    e.who = origin.who ? *origin.who : "";
    e.door = std::string(name_of(origin.door));
    note(std::move(e));
}

std::string WarmGateway::stage_site(Site site, std::uint64_t base_revision, const Origin& origin) {
    return stage_.stage(std::move(site), base_revision, text_of(origin));
}

void WarmGateway::arm_trial(std::chrono::nanoseconds from_now) {
    trial_.expires_after(from_now);
    trial_.async_wait([this](const boost::system::error_code& ec) {
        if (ec || stage_.state() != SiteStage::State::applied) return;
        take_back({Door::internal, std::make_shared<const std::string>("roll back")},
                  fmt::format("the site that {} applied was not confirmed in time: rolled back", stage_.by()), [](SiteAnswer) {});
    });
}

void WarmGateway::apply_stage(std::uint32_t confirm_within_s, Origin origin, std::function<void(SiteAnswer)> then) {
    std::string fault = applying_ ? "another change of the site is being put in force; come again in a moment"
                                  : stage_.begin_apply(site_->revision, confirm_within_s, unix_now_ns(), text_of(origin));
    if (!fault.empty()) {
        boost::asio::post(io_, [this, fault = std::move(fault), then = std::move(then)] { then({false, fault, site_}); });
        return;
    }
    trial_base_ = site_->site;
    auto apply = [this, confirm_within_s, origin, then] {
        on_trial_ = confirm_within_s != 0;
        apply_site(stage_.site(), stage_.base_revision(), origin, [this, confirm_within_s, then](SiteAnswer answer) {
            stage_.applied(answer.good);
            if (answer.good && confirm_within_s != 0) arm_trial(std::chrono::seconds(confirm_within_s));
            if (!answer.good && confirm_within_s != 0) cold_.run([](Store& store) { (void)unmark_trial(store); });
            then(std::move(answer));
        });
        on_trial_ = false;
    };
    if (confirm_within_s == 0) return apply();
    cold_.run([this, to = site_->revision, who = stage_.by(), by = stage_.confirm_by_unix_ns(), apply = std::move(apply),
               then](Store& store) mutable {
        const auto marked = mark_trial(store, to, who, by, unix_now_ns());
        boost::asio::post(
            io_, [this, good = bool(marked), fault = marked ? std::string() : marked.error().text, apply = std::move(apply), then] {
                if (good) return apply();
                stage_.applied(false);
                then({false, fault, site_, true});
            });
    });
}

void WarmGateway::confirm_stage(Origin origin, std::function<void(std::string fault)> then) {
    std::string fault = stage_.check_confirm(text_of(origin), unix_now_ns());
    if (!fault.empty()) {
        boost::asio::post(io_, [fault = std::move(fault), then = std::move(then)] { then(fault); });
        return;
    }
    if (confirming_) {
        boost::asio::post(io_, [then = std::move(then)] { then("it is being confirmed already"); });
        return;
    }
    confirming_ = true;
    trial_.cancel();  // from here on it is the disk that decides, and its answer comes
    cold_.run([this, site = site_->site, origin = std::move(origin), then = std::move(then)](Store& store) {
        const auto done = unmark_trial(store);
        // The same text is not stored again; what the store knew of names that are gone now goes.
        if (done) (void)store.save_site(boost::json::serialize(to_json(site)), origin.text(), unix_now_ns(), names_of(site));
        boost::asio::post(io_, [this, origin, then, good = bool(done), fault = done ? std::string() : done.error().text] {
            confirming_ = false;
            if (good) {
                stage_.confirmed();
                tell_site("the applied site was confirmed", origin, Severity::info);
            } else {
                arm_trial(std::chrono::seconds(try_again_s));
            }
            then(fault);
        });
    });
}

void WarmGateway::roll_back_stage(Origin origin, std::function<void(SiteAnswer)> then) {
    if (stage_.state() != SiteStage::State::applied) {
        boost::asio::post(io_, [this, then = std::move(then)] {
            then({false, "no applied site waits to be confirmed: there is nothing to roll back", site_});
        });
        return;
    }
    if (confirming_) {
        boost::asio::post(io_, [this, then = std::move(then)] { then({false, "the applied site is being confirmed just now", site_}); });
        return;
    }
    std::string why = fmt::format("the site that {} applied was rolled back on demand", stage_.by());
    take_back(std::move(origin), std::move(why), std::move(then));
}

void WarmGateway::take_back(Origin origin, std::string why, std::function<void(SiteAnswer)> then) {
    if (!stage_.begin_roll_back().empty()) return;
    trial_.cancel();
    apply_site(trial_base_, 0, origin, [this, origin, why = std::move(why), then = std::move(then)](SiteAnswer answer) {
        stage_.rolled_back(answer.good, unix_now_ns() + try_again_s * 1'000'000'000);
        if (answer.good) {
            cold_.run([](Store& store) {
                (void)unmark_trial(store);
            });  // left there by a crash or a full disk, it names a site equal to this one
            tell_site(why, origin, Severity::warning);
        } else {
            tell_site(fmt::format("{}, but it could not be: {}; it will be tried again", why, answer.fault), origin, Severity::alarm);
            arm_trial(std::chrono::seconds(try_again_s));
        }
        then(std::move(answer));
    });
}

// --- registers ------------------------------------------------------------------------------------------------------

void WarmGateway::read_registers(std::uint8_t unit, registers::Table table, std::uint16_t address, std::uint16_t count,
                                 std::function<void(std::optional<registers::RegisterRead>)> then) {
    auto job = [this, unit, table, address, count, then](Engine&, Instant) {
        auto read = registers_->read(unit, table, address, count);
        boost::asio::post(io_, [then, read = std::move(read)]() mutable { then(std::move(read)); });
    };
    if (!registers_ || !hot_.jobs().push(std::move(job))) {
        boost::asio::post(io_, [then] { then(std::nullopt); });
        return;
    }
    hot_.jobs().announce();
}

// --- the database as one file ---------------------------------------------------------------------------------------

void WarmGateway::backup(std::function<void(std::optional<std::string> bytes, std::string fault)> then) {
    cold_.run([this, then = std::move(then)](Store& store) {
        const std::string file = fmt::format("{}/{}", store.directory(), download_name);
        std::string fault;
        std::optional<std::string> bytes;
        if (const auto made = store.backup(file); !made) {
            fault = made.error().text;
        } else {
            bytes = read_file(file, fault, most_backup_bytes);
        }
        std::error_code ec;
        std::filesystem::remove(file, ec);
        boost::asio::post(
            io_, [then, bytes = std::move(bytes), fault = std::move(fault)]() mutable { then(std::move(bytes), std::move(fault)); });
    });
}

void WarmGateway::restore(std::string bytes, Origin origin, std::function<void(RestoreFault)> then) {
    cold_.run([this, bytes = std::move(bytes), origin = std::move(origin), then = std::move(then)](Store& store) {
        const auto fault = lay_down_backup(bytes, text_of(origin), unix_now_ns(), store.options());
        boost::asio::post(io_, [this, origin, then, fault] {
            if (fault.text.empty())
                tell_site("a backup was laid down: it takes the place of the database at the next start", origin, Severity::warning);
            then(fault);
        });
    });
}

void WarmGateway::waiting_backup(std::function<void(std::optional<WaitingBackup>)> then) {
    cold_.run([this, then = std::move(then)](Store& store) {
        boost::asio::post(io_, [then, waits = axisgate::waiting_backup(store.directory())] { then(waits); });
    });
}

void WarmGateway::cancel_restore(Origin origin, std::function<void(std::string fault)> then) {
    cold_.run([this, origin = std::move(origin), then = std::move(then)](Store& store) {
        const std::string fault = cancel_waiting_backup(store.directory());
        boost::asio::post(io_, [this, origin, then, fault] {
            if (fault.empty()) tell_site("the backup that was laid down was taken away again: the next start goes on with the database as it is", origin, Severity::warning);
            then(fault);
        });
    });
}

}  // namespace axisgate
