// A trial is marked in the storage before its site is put in force, so that a restart rolls it back, too. The mark is removed from a site
// that becomes permanent.
#include "gateway/runtime/warm_stage.hpp"

#include <fmt/core.h>

#include <boost/json/serialize.hpp>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/site_names.hpp"
#include "gateway/runtime/site_trial.hpp"

namespace axisgate {
namespace {
constexpr std::int64_t try_again_s = 5;  // a roll back that could not be stored is repeated after this time
std::string actor_of(const Origin& origin) { return origin.who ? *origin.who : origin.text(); }
}  // namespace

std::string WarmStage::stage_site(Site site, std::uint64_t base_revision, const Origin& origin) {
    return stage_.stage(std::move(site), base_revision, actor_of(origin));
}

void WarmStage::refuse(std::string fault, std::function<void(SiteAnswer)> then) {
    threads_.answer([this, fault = std::move(fault), then = std::move(then)] { then({false, fault, site_.site()}); });
}

void WarmStage::arm_trial(std::chrono::nanoseconds from_now) {
    trial_.expires_after(from_now);
    trial_.async_wait([this](const boost::system::error_code& ec) {
        if (ec || stage_.state() != SiteStage::State::applied) return;
        take_back({Door::internal, std::make_shared<const std::string>("roll back")},
                  fmt::format("the site that {} applied was not confirmed in time: rolled back", stage_.by()), [](SiteAnswer) {});
    });
}

void WarmStage::put_in_force(std::uint32_t confirm_within_s, const Origin& origin, std::function<void(SiteAnswer)> then) {
    const bool on_trial = confirm_within_s != 0;
    site_.put_in_force(stage_.site(), stage_.base_revision(), on_trial ? &trial_base_ : nullptr, origin,
                       [this, on_trial, confirm_within_s, then = std::move(then)](SiteAnswer answer) {
                           stage_.applied(answer.good);
                           if (answer.good && on_trial) arm_trial(std::chrono::seconds(confirm_within_s));
                           if (!answer.good && on_trial) threads_.on_cold([](Store& store) { (void)unmark_trial(store); });
                           then(std::move(answer));
                       });
}

void WarmStage::apply_stage(std::uint32_t confirm_within_s, Origin origin, std::function<void(SiteAnswer)> then) {
    const auto now = site_.site();
    std::string fault = site_.applying() ? "another change of the site is being put in force; come again in a moment"
                                         : stage_.begin_apply(now->revision, confirm_within_s, unix_now_ns(), actor_of(origin));
    if (!fault.empty()) return refuse(std::move(fault), std::move(then));
    trial_base_ = now->site;
    if (confirm_within_s == 0) return put_in_force(0, origin, std::move(then));
    threads_.on_cold([this, to = now->revision, who = stage_.by(), by = stage_.confirm_by_unix_ns(), confirm_within_s, origin,
                      then](Store& store) {
        const auto marked = mark_trial(store, to, who, by, unix_now_ns());
        threads_.answer([this, good = bool(marked), fault = marked ? std::string() : marked.error().text, confirm_within_s, origin, then] {
            if (good) return put_in_force(confirm_within_s, origin, then);
            stage_.applied(false);
            then({false, fault, site_.site(), true});
        });
    });
}

void WarmStage::confirm_stage(Origin origin, std::function<void(std::string fault)> then) {
    std::string fault = stage_.check_confirm(actor_of(origin), unix_now_ns());
    if (!fault.empty()) {
        threads_.answer([fault = std::move(fault), then = std::move(then)] { then(fault); });
        return;
    }
    if (confirming_) {
        threads_.answer([then = std::move(then)] { then("it is being confirmed already"); });
        return;
    }
    confirming_ = true;
    trial_.cancel();  // from here on the disk decides, and its answer follows
    threads_.on_cold([this, site = site_.site()->site, origin = std::move(origin), then = std::move(then)](Store& store) {
        const auto done = unmark_trial(store);
        // The same text is not stored again; data of names that do not exist any more are removed.
        if (done) (void)store.save_site(boost::json::serialize(to_json(site)), origin.text(), unix_now_ns(), names_of(site));
        threads_.answer([this, origin, then, good = bool(done), fault = done ? std::string() : done.error().text] {
            confirming_ = false;
            if (good) {
                stage_.confirmed();
                events_.note("site", "the applied site was confirmed", origin);
            } else {
                arm_trial(std::chrono::seconds(try_again_s));
            }
            then(fault);
        });
    });
}

void WarmStage::roll_back_stage(Origin origin, std::function<void(SiteAnswer)> then) {
    if (stage_.state() != SiteStage::State::applied)
        return refuse("no applied site waits to be confirmed: there is nothing to roll back", std::move(then));
    if (confirming_) return refuse("the applied site is being confirmed just now", std::move(then));
    std::string why = fmt::format("the site that {} applied was rolled back on demand", stage_.by());
    take_back(std::move(origin), std::move(why), std::move(then));
}

void WarmStage::take_back(Origin origin, std::string why, std::function<void(SiteAnswer)> then) {
    if (!stage_.begin_roll_back().empty()) return;
    trial_.cancel();
    site_.put_in_force(trial_base_, 0, nullptr, origin, [this, origin, why = std::move(why), then = std::move(then)](SiteAnswer answer) {
        stage_.rolled_back(answer.good, unix_now_ns() + try_again_s * 1'000'000'000);
        if (answer.good) {
            threads_.on_cold(
                [](Store& store) { (void)unmark_trial(store); });  // left by a crash or a full disk, it names a site equal to this one
            events_.note("site", why, origin, Severity::warning);
        } else {
            events_.note("site", fmt::format("{}, but it could not be: {}; it will be tried again", why, answer.fault), origin,
                         Severity::alarm);
            arm_trial(std::chrono::seconds(try_again_s));
        }
        then(std::move(answer));
    });
}

}  // namespace axisgate
