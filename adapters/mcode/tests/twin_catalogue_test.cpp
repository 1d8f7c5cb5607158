// Every parameter of the catalogue on the three products: default, range, what is refused, and what S, IP, FD and a reset do with it.
// In: schema/families/mcode.json. Out: one failure per word that does otherwise.
// Never knows a figure of its own, but where values depend on each other.
#include <boost/json.hpp>

#include <fstream>
#include <set>
#include <sstream>

#include "adapters/mcode/tests/twin_wire.hpp"

namespace axisgate::mcode::twin::test {
namespace {

struct Parameter {
    std::string word;
    bool real = false, readable = false, writable = false;
    std::optional<std::int64_t> low, high;
    std::string factory;  ///< as it is printed; empty: depends
    std::vector<std::int64_t> allowed;
    std::string storage;
    std::set<std::string> products;
};

std::vector<Parameter> parameters() {
    std::ifstream file(std::string(AXISGATE_SOURCE_DIR) + "/schema/families/mcode.json");
    std::stringstream text;
    text << file.rdbuf();
    std::vector<Parameter> all;
    const auto json = boost::json::parse(text.str());
    for (const auto& p : json.at("parameters").as_array()) {
        const auto& wire = p.at("wire");
        const std::string form(wire.at("form").as_string());
        if (form != "value" && form != "flag") continue;
        Parameter q;
        q.word = std::string(wire.at("word").as_string());
        if (q.word != p.at("id").as_string()) continue;
        q.real = p.at("type").as_string() == "f64";
        const std::string access(p.at("access").as_string());
        q.readable = access.find('R') != std::string::npos;
        q.writable = access.find('W') != std::string::npos;
        if (p.at("min").is_int64()) q.low = p.at("min").as_int64();
        if (!q.real && p.at("max").is_number()) q.high = p.at("max").to_number<std::int64_t>();
        if (p.at("default").is_int64() && !q.real) q.factory = std::to_string(p.at("default").as_int64());
        if (p.at("allowed").is_object()) {
            for (const auto& [key, meaning] : p.at("allowed").as_object())
                q.allowed.push_back(std::stoll(std::string(key)));
        }
        q.storage = std::string(p.at("storage").as_string());
        for (const auto& x : wire.at("products").as_array())
            q.products.emplace(x.as_string());
        all.push_back(std::move(q));
    }
    return all;
}

/// The link's own words change the line under the test; the tests of link and memory have them.
const std::set<std::string> link{"BD", "CK", "PY", "EM"};
/// Ranges that hang on another word: VI < VM, HT + MT, an untouched TS, an absent trip, what only clears.
const std::set<std::string> depending{"VI", "VM", "HT", "MT", "TS", "TE", "ER", "ST", "IF", "MF"};
/// Words that an open loop has not, for want of an encoder.
const std::set<std::string> encoder{"C2", "DB", "EE", "FS", "I6", "PM", "SF", "SM", "ST"};

template <typename Check>
int for_each(Check check) {
    int seen = 0;
    for (const auto& [name, product] : std::map<std::string, std::uint8_t>{{"lmdo", lmdo}, {"lmdc", lmdc}, {"lmm", lmm}}) {
        for (const Parameter& p : parameters()) {
            if (!p.products.contains(name) || (product == lmdo && encoder.contains(p.word))) continue;
            SCOPED_TRACE(name + " " + p.word);
            check(p, product);
            ++seen;
        }
    }
    return seen;
}

std::string statement(const Parameter& p, std::int64_t v) { return p.word + "=" + std::to_string(v); }

TEST(McodeCatalogue, DefaultsAreThoseOfTheFactory) {
    EXPECT_GT(for_each([](const Parameter& p, std::uint8_t product) {
                  if (!p.readable || p.factory.empty()) return;
                  Wire w(product);
                  EXPECT_EQ(w.ask("PR " + p.word), p.factory);
                  if (!p.writable || link.contains(p.word)) return;
                  (void)w.ask(statement(p, p.high.value_or(7)));
                  (void)w.ask("FD");
                  if (p.storage != "saved_kept" && p.storage != "ram" && p.storage != "status") {
                      EXPECT_EQ(w.ask("PR " + p.word), p.factory) << "after FD";
                  }
              }),
              200);
}

TEST(McodeCatalogue, RangesEndWhereTheyAreSaidToEnd) {
    EXPECT_GT(for_each([](const Parameter& p, std::uint8_t product) {
                  if (p.real || link.contains(p.word) || depending.contains(p.word) || !p.low || !p.high) return;
                  Wire w(product);
                  w.hand("temperature", Value{-5.0});  // below each WT
                  w.hand("controller_temperature", Value{-5.0});
                  if (!p.writable) {
                      EXPECT_EQ(w.error_of(statement(p, *p.low)), 25);
                      EXPECT_EQ(w.error_of("IC " + p.word), 25);
                      return;
                  }
                  for (const std::int64_t v : {*p.low - 1, *p.high + 1})
                      EXPECT_EQ(w.error_of(statement(p, v)), 21) << v;
                  if (p.readable && !p.factory.empty()) EXPECT_EQ(w.ask("PR " + p.word), p.factory) << "what is refused changes nothing";
                  for (std::int64_t v = *p.low; v <= *p.high && *p.high <= 300; ++v) {
                      const bool good = p.allowed.empty() || std::ranges::find(p.allowed, v) != p.allowed.end();
                      if (p.word == "AS" && v == 3) continue;  // it would move
                      EXPECT_EQ(w.error_of(statement(p, v)), good ? 0 : 21) << v;
                      if (good && p.readable) EXPECT_EQ(w.number(p.word), v);
                  }
                  for (const std::int64_t v : {*p.low, *p.high}) {
                      if (p.word == "AS" && v == 3) continue;
                      EXPECT_EQ(w.error_of(statement(p, v)), 0) << v;
                      if (p.readable) EXPECT_EQ(w.ask("PR " + p.word), std::to_string(v));
                  }
              }),
              200);
}

TEST(McodeCatalogue, FractionsAreDroppedAndTextIsRefused) {
    EXPECT_GT(for_each([](const Parameter& p, std::uint8_t product) {
                  if (p.real || !p.writable || !p.readable || !p.high || link.contains(p.word) || depending.contains(p.word)) return;
                  if (p.word == "AS") return;
                  Wire w(product);
                  EXPECT_EQ(w.error_of(p.word + "=" + std::to_string(*p.high) + ".9"), 0);
                  EXPECT_EQ(w.ask("PR " + p.word), std::to_string(*p.high));
                  EXPECT_EQ(w.error_of(p.word + "=\"1\""), 38);
                  EXPECT_EQ(w.error_of(p.word + "="), 21);
                  EXPECT_EQ(w.error_of(p.word + "=1,2"), 21);
                  EXPECT_EQ(w.error_of(p.word), 34);
              }),
              200);
}

TEST(McodeCatalogue, SaveResetInitializeAndFactoryDefaults) {
    EXPECT_GT(for_each([](const Parameter& p, std::uint8_t product) {
                  if (p.real || !p.writable || !p.readable || p.factory.empty() || link.contains(p.word)) return;
                  std::int64_t other = p.allowed.empty() ? *p.low + (*p.high - *p.low) / 2 : p.allowed.front();
                  if (p.word == "VI" || p.word == "HT" || p.word == "MT") other = 777;
                  if (p.word == "TS") other = 51200;
                  if (std::to_string(other) == p.factory) other = p.allowed.empty() ? *p.high : p.allowed.back();
                  if (p.word == "AS") other = 1;
                  const bool saved = p.storage.starts_with("saved");
                  Wire w(product);
                  if (w.error_of(statement(p, other)) != 0) {
                      EXPECT_TRUE(depending.contains(p.word)) << other;
                      return;
                  }
                  const std::string now = std::to_string(other);
                  EXPECT_EQ(w.ask("PR " + p.word), now);
                  if (p.word != "CE") {  // CTRL+C may be off
                      w.bytes("\x03");
                      EXPECT_EQ(w.ask("PR " + p.word), p.factory) << "not saved: the reset takes it back";
                      (void)w.ask(statement(p, other));
                  }
                  (void)w.ask("S");
                  if (saved && p.word != "LK") {
                      (void)w.ask(statement(p, std::stoll(p.factory)));
                      (void)w.ask("IP");
                      EXPECT_EQ(w.ask("PR " + p.word), p.word == "TS" ? "51200" : now) << "IP";
                  }
                  Wire after(product, '!', w.device->non_volatile());
                  EXPECT_EQ(after.ask("PR " + p.word), saved ? now : p.factory) << "power";
                  (void)after.ask("FD");
                  EXPECT_EQ(after.ask("PR " + p.word), p.storage == "saved_kept" ? now : p.factory) << "FD";
              }),
              200);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
