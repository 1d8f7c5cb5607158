// The list of subjects, and a family whose velocity mode was removed.
#include "tests/conformance/laws.hpp"

#include <fstream>
#include <iterator>

namespace axisgate::test {
namespace {

/// The first family's adapter without velocity moves.
class WithoutVelocity final : public PassingAdapter {
public:
    using PassingAdapter::PassingAdapter;
    void on_command(const Command& command, Instant now, Out& out) override {
        const auto* move = std::get_if<Move>(&command.body);
        if (!move || move->kind != Move::Kind::velocity) return PassingAdapter::on_command(command, now, out);
        Result r;
        r.ticket = command.ticket;
        r.axis = command.axis;
        r.outcome = Outcome::refused;
        r.reason = Reason::not_supported;
        r.text = "this drive has no velocity mode: use a positioning";
        if (command.ticket != no_ticket) out.results.push_back(std::move(r));
    }
};

const Family& family_without_velocity() {
    static const Family& base = *families().entries.front().family;
    static const Family changed = [] {
        Family f = base;
        f.served_by = nullptr;
        f.make_adapter = [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> {
            return std::make_unique<WithoutVelocity>(base.make_adapter(c, kind));
        };
        return f;
    }();
    return changed;
}

}  // namespace

bool Laws::fact(const std::string& name) const {
    const std::string path = std::string(AXISGATE_SOURCE_DIR "/adapters/") + std::string(e.family->name) + "/tests/facts.json";
    std::ifstream file(path);
    const auto facts = boost::json::parse(std::string(std::istreambuf_iterator<char>(file), {})).get_object();
    const auto* reported = facts.if_contains(name);
    EXPECT_TRUE(reported && reported->is_bool()) << name << " is missing in " << path;
    return reported && reported->is_bool() && reported->get_bool();
}

void Laws::lacks_velocity(const Result& r) const {
    EXPECT_FALSE(r.text.empty()) << "where a drive cannot follow, it says so";
    if (e.variant.empty()) EXPECT_FALSE(fact("velocity_mode")) << "by its manual the drive has a velocity mode, and: " << published(&r);
}

const std::vector<Subject>& law_subjects() {
    static const std::vector<Subject> all = [] {
        std::vector<Subject> list = subjects();
        Subject changed = list.front();
        changed.family = &family_without_velocity();
        changed.variant = "without_velocity";
        list.push_back(changed);
        return list;
    }();
    return all;
}

}  // namespace axisgate::test
