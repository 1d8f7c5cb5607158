// Boost's parser calls a handler that builds the value and keeps the names of each open object. Names of a finished object are dropped.
#include "gateway/core/json_read.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/basic_parser_impl.hpp>
#include <boost/json/value_stack.hpp>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace axisgate {
namespace {
namespace json = boost::json;
using Error = boost::system::error_code;
constexpr std::size_t most_depth = 32;
constexpr std::size_t most_shown_name = 64, most_shown_pointer = 512;  // a name may have as many bytes as the text

/// At most this number of bytes, not cut inside a character.
std::string shortened(std::string_view s, std::size_t most) {
    if (s.size() <= most) return std::string(s);
    while (most > 0 && (static_cast<unsigned char>(s[most]) & 0xC0u) == 0x80u)
        --most;
    return std::string(s.substr(0, most)) + "...";
}

void put_token(std::string& pointer, std::string_view token) {
    pointer += '/';
    for (const char c : token) {
        if (c == '~') {
            pointer += "~0";
        } else if (c == '/') {
            pointer += "~1";
        } else {
            pointer += c;
        }
    }
}

/// The handler of basic_parser; names and signatures are the library's.
class Builder {
public:
    static constexpr std::size_t max_object_size = std::size_t(-1);
    static constexpr std::size_t max_array_size = std::size_t(-1);
    static constexpr std::size_t max_key_size = std::size_t(-1);
    static constexpr std::size_t max_string_size = std::size_t(-1);

    [[nodiscard]] json::value release() { return stack_.release(); }
    [[nodiscard]] const std::string& name_that_stands_twice() const noexcept { return twice_; }
    [[nodiscard]] bool found_twice() const noexcept { return found_; }
    [[nodiscard]] std::string pointer() const {
        std::string out;
        for (const Level& l : open_) {
            const std::string token = l.is_array ? std::to_string(l.items) : l.name;
            if (out.size() + token.size() > most_shown_pointer) break;
            put_token(out, token);
        }
        return out;
    }

    bool on_document_begin(Error&) { return true; }
    bool on_document_end(Error&) { return true; }
    bool on_object_begin(Error&) {
        open_.push_back({});
        return true;
    }
    bool on_object_end(std::size_t n, Error&) {
        open_.pop_back();
        stack_.push_object(n);
        return ended();
    }
    bool on_array_begin(Error&) {
        open_.push_back({.is_array = true});
        return true;
    }
    bool on_array_end(std::size_t n, Error&) {
        open_.pop_back();
        stack_.push_array(n);
        return ended();
    }
    bool on_key_part(json::string_view s, std::size_t, Error&) {
        key_.append(s.data(), s.size());
        stack_.push_chars(s);
        return true;
    }
    bool on_key(json::string_view s, std::size_t, Error& ec) {
        key_.append(s.data(), s.size());
        stack_.push_key(s);
        Level& l = open_.back();
        l.name = std::exchange(key_, {});
        if (l.names.insert(l.name).second) return true;
        found_ = true;
        twice_ = l.name;
        ec = boost::system::errc::make_error_code(boost::system::errc::invalid_argument);
        return false;
    }
    bool on_string_part(json::string_view s, std::size_t, Error&) {
        stack_.push_chars(s);
        return true;
    }
    bool on_string(json::string_view s, std::size_t, Error&) {
        stack_.push_string(s);
        return ended();
    }
    bool on_number_part(json::string_view, Error&) { return true; }
    bool on_int64(std::int64_t i, json::string_view, Error&) {
        stack_.push_int64(i);
        return ended();
    }
    bool on_uint64(std::uint64_t u, json::string_view, Error&) {
        stack_.push_uint64(u);
        return ended();
    }
    bool on_double(double d, json::string_view, Error&) {
        // The library makes NaN of "0e999", which would pass every comparison with a limit.
        stack_.push_double(std::isnan(d) ? 0.0 : d);
        return ended();
    }
    bool on_bool(bool b, Error&) {
        stack_.push_bool(b);
        return ended();
    }
    bool on_null(Error&) {
        stack_.push_null();
        return ended();
    }
    bool on_comment_part(json::string_view, Error&) { return true; }
    bool on_comment(json::string_view, Error&) { return true; }
    void start() { stack_.reset(); }

private:
    struct Level {
        bool is_array = false;
        std::size_t items = 0;  ///< of an array, the number of finished elements
        std::string name{};     ///< of an object, the member that is being read
        std::set<std::string> names{};
    };
    bool ended() {
        if (!open_.empty() && open_.back().is_array) ++open_.back().items;
        return true;
    }

    json::value_stack stack_;
    std::vector<Level> open_;
    std::string key_;  ///< of a name that comes in parts
    std::string twice_;
    bool found_ = false;
};
}  // namespace

std::optional<json::value> read_json(std::string_view text, JsonFault& fault) {
    json::parse_options options;
    options.max_depth = most_depth;
    json::basic_parser<Builder> parser(options);
    parser.handler().start();
    Error ec;
    const std::size_t used = parser.write_some(false, text.data(), text.size(), ec);
    if (!ec && used == text.size()) return parser.handler().release();
    fault = {};
    fault.line = 1 + static_cast<std::size_t>(
                         std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(used, text.size())), '\n'));
    const Builder& builder = parser.handler();
    fault.twice = builder.found_twice();
    fault.text = fault.twice ? fmt::format("the member \"{}\" stands twice", shortened(builder.name_that_stands_twice(), most_shown_name))
                             : (ec ? ec : json::make_error_code(json::error::extra_data)).message();
    if (fault.twice) fault.pointer = builder.pointer();
    return std::nullopt;
}

Value value_of_json(const json::value& v) {
    if (v.is_bool()) return v.get_bool();
    if (v.is_int64()) return v.get_int64();
    if (v.is_uint64()) return static_cast<double>(v.get_uint64());
    if (v.is_double()) return v.get_double();
    if (v.is_string()) return std::string(v.get_string());
    return {};
}

}  // namespace axisgate
