// Laws: the list of subjects, and the family without a velocity mode.
// In: all_families(), adapters/<family>/tests/facts.json. Out: subjects. Never changes what a family does otherwise.
#include "tests/conformance/laws.hpp"

#include <fstream>
#include <iterator>

namespace axisgate::test {
namespace {

/// The first family's adapter, which has never heard of velocity moves.
class WithoutVelocity final : public Adapter {
public:
    explicit WithoutVelocity(std::unique_ptr<Adapter> inner) : inner_(std::move(inner)) {}
    void configure(const LineSetup& setup, Instant now, Out& out) override { inner_->configure(setup, now, out); }
    void on_line(bool up, Instant now, Out& out) override { inner_->on_line(up, now, out); }
    void on_command(const Command& command, Instant now, Out& out) override {
        const auto* move = std::get_if<Move>(&command.body);
        if (!move || move->kind != Move::Kind::velocity) return inner_->on_command(command, now, out);
        Result r;
        r.ticket = command.ticket;
        r.axis = command.axis;
        r.outcome = Outcome::refused;
        r.reason = Reason::not_supported;
        r.text = "this drive has no velocity mode: use a positioning";
        if (command.ticket != no_ticket) out.results.push_back(std::move(r));
    }
    void on_set_point(const SetPoint& p, Instant now, Out& out) override { inner_->on_set_point(p, now, out); }
    void on_frame(const Frame& frame, Instant now, Out& out) override { inner_->on_frame(frame, now, out); }
    void on_deadline(Instant now, Out& out) override { inner_->on_deadline(now, out); }
    [[nodiscard]] Instant deadline() const override { return inner_->deadline(); }
    [[nodiscard]] AdapterCounters counters() const override { return inner_->counters(); }

private:
    std::unique_ptr<Adapter> inner_;
};

const Family& family_without_velocity() {
    static const Family& base = *families().entries.front().family;
    static const Family changed = [] {
        Family f = base;
        f.make_adapter = [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> {
            return std::make_unique<WithoutVelocity>(base.make_adapter(c, kind));
        };
        return f;
    }();
    return changed;
}

}  // namespace

void Laws::lacks_velocity(const Result& r) const {
    EXPECT_FALSE(r.text.empty()) << "where a drive cannot follow, it says so";
    if (!e.variant.empty()) return;
    const std::string path = std::string(AXISGATE_SOURCE_DIR "/adapters/") + std::string(e.family->name) + "/tests/facts.json";
    std::ifstream file(path);
    const auto facts = boost::json::parse(std::string(std::istreambuf_iterator<char>(file), {})).get_object();
    const auto* velocity = facts.if_contains("velocity_mode");
    EXPECT_TRUE(velocity && !velocity->get_bool()) << "by its manual the drive has a velocity mode (" << path << "), and: " << told(&r);
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
