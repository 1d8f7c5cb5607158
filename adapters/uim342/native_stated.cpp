// Stated: what a line of instructions, an action or a parameter write would do to the axis, read before it is sent.
// In: bodies of commands. Out: a motion that BG begins with values of the same line, rates for later ones, or that it cannot be read.
// Never knows what the drive holds: a BG whose target is not in its line, and a driver that is switched on over an old target, are unread.
#include <cstdlib>
#include <optional>
#include <span>

#include "adapters/uim342/native.hpp"
#include "adapters/uim342/parameters_points.hpp"
#include "adapters/uim342/wire_instructions.hpp"

namespace axisgate::uim342 {
namespace {
/// Input actions 04h and 07h to 0Bh begin a motion when their edge comes, or at power-on [L1000].
bool begins_motion(std::int64_t edges) {
    const auto moves = [](std::int64_t edge) {
        const auto action = edge & 0x7F;
        return action == 4 || action >= 7;
    };
    return moves(edges) || moves(edges >> 8);
}

class Line {
public:
    void take(const Message& m) {
        const Instruction* i = instruction(m.cw);
        const Form form = form_of(m);
        if (!i || form == Form::unknown) return unread();
        const bool after_stop = std::exchange(stopped_, false);
        if (form == Form::get) return;
        const std::uint8_t group = i->takes_mf ? std::exchange(group_, std::uint8_t{0}) : std::uint8_t{0};
        Message whole = m;  // short data words are zero-extended
        whole.dl = 8;
        const std::int64_t v = value_of(m, whole).value_or(0);
        switch (m.function()) {
            case cw::MF:
                group_ = static_cast<std::uint8_t>(v);
                return;
            case cw::PA:
                return load(Move::Kind::absolute, v, group);
            case cw::PR:
                return load(Move::Kind::relative, v, group);
            case cw::JV:
                return load(Move::Kind::velocity, v, group);
            case cw::SP:
                return rate(out_.sets.velocity, std::llabs(v), group);
            case cw::AC:
                return rate(out_.sets.acceleration, v, group);
            case cw::DC:
                return rate(out_.sets.deceleration, v, group);
            case cw::SD:
                return rate(out_.sets.quick_stop, v, group);
            case cw::ST:
                stopped_ = true;
                return;
            case cw::MO:  // "unexpected movement when turning on" [L1264]
                if (v != 0 && (!after_stop || loaded_)) unread();
                return;
            case cw::BG:
                return loaded_ ? begin() : unread();
            case cw::IL:
                if (m.d[0] < 3 && begins_motion(v)) unread();
                return;
            case cw::SY:  // a restart begins with what is stored: driver on, actions at power-on
                if (m.d[0] != 2) unread();
                return;
            default:
                return;
        }
    }
    [[nodiscard]] const Stated& said() const noexcept { return out_; }

private:
    void unread() noexcept { out_.kind = Stated::Kind::unread; }
    void load(Move::Kind kind, std::int64_t target, std::uint8_t group) {
        if (group != 0) return;
        loaded_ = Move{};
        loaded_->kind = kind;
        loaded_->target = target;
    }
    static void rate(std::int64_t& to, std::int64_t value, std::uint8_t group) {
        if (group == 0 && value > 0) to = value;
    }
    void begin() {
        if (out_.kind != Stated::Kind::nothing) return;
        out_.kind = Stated::Kind::motion;
        out_.move = *loaded_;
        const auto named = [](std::int64_t rate) { return rate > 0 ? std::optional(rate) : std::nullopt; };
        if (loaded_->kind != Move::Kind::velocity) out_.move.velocity = named(out_.sets.velocity);
        out_.move.acceleration = named(out_.sets.acceleration);
        out_.move.deceleration = named(out_.sets.deceleration);
    }

    Stated out_{Stated::Kind::nothing};
    std::optional<Move> loaded_;
    std::uint8_t group_ = 0;
    bool stopped_ = false;  ///< by the instruction before
};

Stated read(const NativeScript& script) {
    if (!script.fault.empty()) return {Stated::Kind::nothing};  // it is refused, and nothing is sent
    Line line;
    for (const Message& m : script.messages)
        line.take(m);
    return line.said();
}

Stated read(const Catalogue& catalogue, const WriteParameter& write) {
    const Points points(catalogue);
    const Binding* b = points.binding(write.point);
    const auto v = as_integer(write.value);
    if (!b || !v || b->instruction->set_dl < 0 || b->mf != 0) return {Stated::Kind::nothing};
    if (b->instruction->cw == cw::MO) return {Stated::Kind::nothing};  // goes behind an ST
    if (b->part) {
        const bool action = b->instruction->cw == cw::IL && b->index < 3 && begins_motion(*v & 0x7F);
        return {action ? Stated::Kind::unread : Stated::Kind::nothing};
    }
    Line line;
    line.take(make_set(first_node, *b->instruction, b->index, *v));
    return line.said();
}
}  // namespace

Stated stated(const Catalogue& catalogue, int, const CommandBody& body) {
    if (const auto* write = std::get_if<WriteParameter>(&body)) return read(catalogue, *write);
    if (const auto* native = std::get_if<Native>(&body)) {
        const std::span<const std::uint8_t> bytes(native->send);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        return read(native->is_text ? parse_native(first_node, text) : parse_native(first_node, bytes));
    }
    if (const auto* action = std::get_if<Action>(&body)) {
        if (action->name == "start_group") return {Stated::Kind::unread};  // what each member has prepared
        if (action->name == "global_stop") return {Stated::Kind::nothing};
        const std::string line = script_of(*action, catalogue);
        return line.empty() ? Stated{Stated::Kind::nothing} : read(parse_native(first_node, line));
    }
    return {Stated::Kind::nothing};
}

}  // namespace axisgate::uim342
