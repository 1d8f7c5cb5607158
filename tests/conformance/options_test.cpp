// The options that a site may give a line, a drive and a twin: listed for every family, checked, and wrong ones reported.
#include <gtest/gtest.h>

#include <set>

#include "gateway/site/options.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class Options : public Laws {
protected:
    const boost::json::array& list() { return e.catalogue->document().at("options").as_array(); }
    static std::vector<OptionOf> places_of(const boost::json::object& o) {
        std::vector<OptionOf> out;
        for (const auto& v : o.at("of").as_array()) {
            const std::string_view place = v.as_string();
            EXPECT_TRUE(place == "line" || place == "drive" || place == "twin") << place;
            out.push_back(place == "line" ? OptionOf::line : place == "drive" ? OptionOf::drive : OptionOf::twin);
        }
        return out;
    }
};

TEST_P(Options, EachIsDescribedAndItsDefaultIsGood) {
    std::set<std::string> names;
    for (const auto& v : list()) {
        const auto& o = v.as_object();
        const std::string name(o.at("name").as_string());
        EXPECT_TRUE(names.insert(name).second) << name << " is there twice";
        EXPECT_GT(o.at("description").as_string().size(), 10u) << name;
        for (const OptionOf place : places_of(o)) {
            if (o.at("default").is_string()) {
                EXPECT_EQ(check_option(*e.catalogue, {place}, name, std::string_view(o.at("default").as_string())), "");
            }
            if (o.contains("values")) {
                for (const auto& good : o.at("values").as_array())
                    EXPECT_EQ(check_option(*e.catalogue, {place}, name, std::string_view(good.as_string())), "");
                EXPECT_NE(check_option(*e.catalogue, {place}, name, "no such value"), "") << name;
                EXPECT_NE(check_option(*e.catalogue, {place}, name, ""), "") << name;
            } else if (o.contains("min")) {
                const auto low = o.at("min").as_int64(), high = o.at("max").as_int64();
                for (const auto n : {low, high})
                    EXPECT_EQ(check_option(*e.catalogue, {place}, name, std::to_string(n)), "") << name;
                for (const auto n : {low - 1, high + 1})
                    EXPECT_NE(check_option(*e.catalogue, {place}, name, std::to_string(n)), "") << name;
                for (const auto* odd : {"", "1x", "0x1", " 1", "1.5", "99999999999999999999"}) {
                    EXPECT_NE(check_option(*e.catalogue, {place}, name, odd), "") << name << " = " << odd;
                }
            }
        }
    }
    EXPECT_FALSE(names.empty());
}

TEST_P(Options, AnUnknownOneIsNamedWithThoseThatAre) {
    const std::string wrong = check_option(*e.catalogue, {OptionOf::drive, OptionOf::twin}, "modell", "1");
    EXPECT_NE(wrong.find("modell"), std::string::npos) << wrong;
    EXPECT_NE(wrong.find(e.catalogue->family()), std::string::npos) << wrong;
    for (const auto& v : list()) {
        const auto places = places_of(v.as_object());
        const std::string name(v.as_object().at("name").as_string());
        const bool here = std::ranges::any_of(places, [](OptionOf p) { return p != OptionOf::line; });
        EXPECT_EQ((wrong + ",").find(" " + name + ",") != std::string::npos, here) << name << " in: " << wrong;
    }
}

TEST_P(Options, ASiteWithAWrongOneIsUsedAndSaysSo) {
    World& w = *world;
    Site wanted = w.twins(e, 2);
    wanted.lines[0].options["modell"] = "1";
    wanted.lines[0].options["full_duplex"] = "false";
    wanted.drives.back().options["such option"] = "2";
    const auto published = [&](std::string_view text) {
        return std::ranges::count_if(w.events, [&](const Event& v) {
            return v.kind == "setup" && v.severity == Severity::warning && v.text.find(text) != std::string::npos;
        });
    };
    const auto state = w.apply(wanted);
    w.run_for(2s);
    EXPECT_NE(w.picture(state->axis_ids.at(0)).flags & flag_online, 0) << "an option that nobody knows stops nobody";
    EXPECT_EQ(published("modell"), 1);
    EXPECT_EQ(published("full_duplex"), 0) << "the gateway's own";
    EXPECT_EQ(published("such option"), 1);
    w.apply(wanted);
    w.run_for(1s);
    EXPECT_EQ(published("modell"), 1) << "said of what is new, not with every change of the site";
}

INSTANTIATE_TEST_SUITE_P(Families, Options, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
