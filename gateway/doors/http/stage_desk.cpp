// Stage desk: ids are letters of this run of the program and a number, so that an id of before a restart fits nothing.
// In: the stage, callers. Out: ids, whose it is. Never keeps more than the present stage.
#include "gateway/doors/http/stage_desk.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/doors/http/secrets.hpp"

namespace axisgate::http {
namespace {
constexpr std::size_t run_letters = 6;
const std::string nobody;

std::string client_of(const Origin& by) { return by.client ? *by.client : by.text(); }
}  // namespace

StageDesk::StageDesk() : run_(random_secret().substr(0, run_letters)) {
    std::ranges::replace_if(run_, [](char c) { return c == '-' || c == '_'; }, '0');
}

std::string StageDesk::id(const SiteStage& stage) const { return fmt::format("{}-{}", run_, stage.id()); }

void StageDesk::staged(const SiteStage& stage, const Origin& by, std::int64_t at_unix_ns) {
    serial_ = stage.id();
    at_unix_ns_ = at_unix_ns;
    stager_ = client_of(by);
    applier_.clear();
    applier_session_.clear();
}

void StageDesk::applied(const SiteStage& stage, const Origin& by, std::string session) {
    if (stage.id() != serial_) return;
    applier_ = client_of(by);
    applier_session_ = std::move(session);
}

const std::string& StageDesk::stager(const SiteStage& stage) const { return stage.id() == serial_ ? stager_ : nobody; }
const std::string& StageDesk::applier(const SiteStage& stage) const { return stage.id() == serial_ ? applier_ : nobody; }

const std::string& StageDesk::applier_session(const SiteStage& stage) const { return stage.id() == serial_ ? applier_session_ : nobody; }

}  // namespace axisgate::http
