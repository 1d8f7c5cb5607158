// An id consists of letters for this run of the program and a number, so that an id from before a restart fits nothing.
#include "gateway/services/site/stage_owner.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/services/access/secrets.hpp"

namespace axisgate {
namespace {
constexpr std::size_t run_letters = 6;
const std::string nobody;

std::string client_of(const Origin& by) { return by.client ? *by.client : by.text(); }
}  // namespace

StageOwner::StageOwner() : run_(random_secret().substr(0, run_letters)) {
    std::ranges::replace_if(
        run_, [](char c) { return c == '-' || c == '_'; }, '0');
}

std::string StageOwner::id(const SiteStage& stage) const { return fmt::format("{}-{}", run_, stage.id()); }

void StageOwner::staged(const SiteStage& stage, const Origin& by, std::int64_t at_unix_ns) {
    serial_ = stage.id();
    at_unix_ns_ = at_unix_ns;
    stager_ = client_of(by);
    applier_.clear();
    applier_session_.clear();
}

void StageOwner::applied(const SiteStage& stage, const Origin& by, std::string session) {
    if (stage.id() != serial_) return;
    applier_ = client_of(by);
    applier_session_ = std::move(session);
}

const std::string& StageOwner::stager(const SiteStage& stage) const { return stage.id() == serial_ ? stager_ : nobody; }
const std::string& StageOwner::applier(const SiteStage& stage) const { return stage.id() == serial_ ? applier_ : nobody; }

const std::string& StageOwner::applier_session(const SiteStage& stage) const { return stage.id() == serial_ ? applier_session_ : nobody; }

}  // namespace axisgate
