// Converts the members of a body to those of a wish.
#include "gateway/services/command_reader.hpp"

#include "gateway/core/text.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

const json::value* member(const json::object& body, std::string_view key) {
    const auto* v = body.if_contains(key);
    return v && !v->is_null() ? v : nullptr;
}
WishedNumber number_in(const json::object& body, std::string_view key) {
    const auto* v = member(body, key);
    if (!v) return {};
    if (!v->is_number()) return NoNumber{json_text(*v)};
    return v->to_number<double>();
}
WishedFlag flag_in(const json::object& body, std::string_view key) {
    const auto* v = member(body, key);
    if (!v) return WishedFlag::no;
    if (!v->is_bool()) return WishedFlag::no_flag;
    return v->get_bool() ? WishedFlag::yes : WishedFlag::no;
}
}  // namespace

CommandWish read_command_wish(const json::object& body) {
    CommandWish wish;
    const auto* c = body.if_contains("command");
    if (!c || !c->is_string()) {
        wish.word = c ? CommandWord::no_text : CommandWord::missing;
        return wish;
    }
    wish = CommandWish::named(std::string_view(c->get_string()));
    for (const auto& [k, v] : body) {
        const std::string_view key = k;
        if (key != "command" && !takes(wish.word, key)) wish.unknown.emplace_back(key);
    }
    const auto number = [&](std::string_view key) { return takes(wish.word, key) ? number_in(body, key) : WishedNumber(); };
    const auto flag = [&](std::string_view key) { return takes(wish.word, key) ? flag_in(body, key) : WishedFlag::no; };
    wish.position = number("position");
    wish.velocity = number("velocity");
    wish.acceleration = number("acceleration");
    wish.deceleration = number("deceleration");
    wish.method = number("method");
    wish.hold_ms = number("hold_ms");
    wish.prepare = flag("prepare");
    wish.renew = flag("renew");
    return wish;
}

SetPointWish read_set_point_wish(const json::object& body) {
    SetPointWish wish;
    for (const auto& [k, v] : body) {
        if (!is_set_point_member(k)) wish.unknown.emplace_back(std::string_view(k));
    }
    const auto* mode = body.if_contains("mode");
    if (mode && mode->is_string()) wish.mode = set_point_mode_of(std::string_view(mode->get_string()));
    wish.value = number_in(body, "value");
    wish.velocity = number_in(body, "velocity");
    wish.acceleration = number_in(body, "acceleration");
    wish.deceleration = number_in(body, "deceleration");
    wish.good_for_ms = number_in(body, "good_for_ms");
    return wish;
}

}  // namespace axisgate
