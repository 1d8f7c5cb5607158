// A queue of password hashes, and one thread that starts with the first of them. Passwords, tokens and codes are never logged.
#include "gateway/runtime/access_service.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include <boost/asio/post.hpp>

#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/threads.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate {
namespace asio = boost::asio;
namespace {
constexpr std::size_t most_waiting = 8;
}  // namespace

std::string session_cookie_of(const std::string& data_dir) {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = 0;
    std::error_code bad;
    const std::filesystem::path place = std::filesystem::weakly_canonical(data_dir, bad);
    return "axisgate_session_" + digest_of(fmt::format("{} {}", host.data(), bad ? data_dir : place.string())).substr(0, 8);
}

AccessService::AccessService(asio::io_context& warm, Cold& cold, AccessSettings settings, Note note)
    : warm_(warm), cold_(cold), accounts_(settings), note_(std::move(note)) {}

AccessService::~AccessService() { stop(); }

void AccessService::stop() {
    if (!pool_) return;
    pool_->stop();
    pool_->join();
    pool_.reset();
}

std::string AccessService::load(Store& store, bool new_code, std::string& code) {
    const auto users = store.documents("user");
    const auto tokens = store.documents("token");
    const auto first = store.document("first_sign_in", code_record_name);
    const auto uses = store.documents("last_use");
    for (const auto* r : {&users, &tokens, &uses}) {
        if (!*r) return "the users cannot be read: " + r->error().text;
    }
    if (!first) return "the users cannot be read: " + first.error().text;
    for (const auto& d : *users) {
        auto u = user_of(d.text);
        // A user whose record cannot be read must not open the way to a first sign-in.
        if (!u) return fmt::format("the record of the user {} cannot be read: restore a backup", d.name);
        accounts_.load(std::move(*u));
    }
    for (const auto& d : *tokens) {
        if (auto t = token_of(d.text)) accounts_.load(std::move(*t));
    }
    for (const auto& d : *uses)
        accounts_.load_use(d.name, d.text);
    if (accounts_.has_users()) return {};
    if (*first && !new_code) {
        accounts_.load_code(code_of((*first)->text));
        return {};
    }
    code = random_code();
    new_code_ = record_of_code(digest_of(plain_code(code)));
    accounts_.load_code(code_of(*new_code_->text));
    return {};
}

bool AccessService::code_is_kept() {
    if (!new_code_) return true;
    if (std::exchange(keeping_code_, true)) return false;
    const bool queued = changes->run(
        [this](std::function<void()> done) {
            if (accounts_.has_users()) {  // the code was used already
                new_code_.reset();
                return done();
            }
            keep({*new_code_}, "", [this, done](const std::string& fault) {
                if (!fault.empty()) {
                    Event e;
                    e.kind = "access";
                    e.severity = Severity::warning;
                    e.text = "the code of the first sign-in is not stored, the next start shows another: " + fault;
                    note(std::move(e));
                }
                new_code_.reset();
                done();
            });
        },
        nullptr);
    if (!queued) keeping_code_ = false;
    return !new_code_;
}

template <class Make, class Then>
bool AccessService::work(Make make, Then then) {
    if (waiting_ >= most_waiting) return false;
    ++waiting_;
    if (!pool_) {
        pool_ = std::make_unique<asio::thread_pool>(1);
        asio::post(*pool_, [] { enter_thread("axisgate-secret", secret_stands_back); });
    }
    asio::post(*pool_, [this, make = std::move(make), then = std::move(then)]() mutable {
        auto made = make();
        asio::post(warm_, [this, made = std::move(made), then = std::move(then)]() mutable {
            --waiting_;
            then(std::move(made));
        });
    });
    return true;
}

bool AccessService::derive(std::string password, std::function<void(std::string)> then) {
    return work([password = std::move(password)] { return derive_password(password); }, std::move(then));
}

bool AccessService::compare(std::string password, std::string hash, std::function<void(bool)> then) {
    return work([password = std::move(password), hash = std::move(hash)] { return password_fits(password, hash); }, std::move(then));
}

void AccessService::keep(std::vector<AccessRecord> records, std::string who, std::function<void(std::string)> then) {
    cold_.run([this, records = std::move(records), who = std::move(who), then = std::move(then)](Store& store) mutable {
        std::string fault;
        for (const auto& r : records) {
            if (!fault.empty()) break;
            if (r.text) {
                const auto saved = store.save_document({r.kind, r.name, *r.text, who, unix_now_ns()});
                if (!saved) fault = saved.error().text;
            } else if (const auto gone = store.delete_document(r.kind, r.name); !gone && gone.error().kind != StoreError::Kind::not_found) {
                fault = gone.error().text;
            }
        }
        asio::post(warm_, [fault = std::move(fault), then = std::move(then)] { then(fault); });
    });
}

}  // namespace axisgate
