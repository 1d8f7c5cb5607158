// Which axes of a new site are former ones under another name; and the backup that waits for the next start.
#include <gtest/gtest.h>

#include <boost/json/parse.hpp>
#include <fstream>

#include "gateway/core/assets.hpp"
#include "gateway/runtime/site_names.hpp"
#include "gateway/runtime/waiting_backup.hpp"
#include "gateway/store/store.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {

boost::json::value site(std::string_view drives, std::string_view axes) {
    return boost::json::parse(R"({"lines":[{"name":"l","family":"demo"},{"name":"m","family":"other"}],"drives":[)" + std::string(drives) +
                              R"(],"axes":[)" + std::string(axes) + "]}");
}
std::string published(const std::vector<NameChange>& changes) {
    std::string out;
    for (const auto& c : changes)
        out += c.from + ">" + c.to + " ";
    return out;
}
constexpr const char* drives =
    R"({"name":"d","line":"l","address":5},{"name":"e","line":"l","address":6},{"name":"f","line":"m","address":5})";
constexpr const char* axes = R"({"name":"x","drive":"d","channel":1},{"name":"y","drive":"e","channel":1})";

TEST(SiteNames, AnAxisThatStandsWhereAnotherStoodIsThatOne) {
    const auto before = site(drives, axes);
    const auto axes_of = [&](const char* d, const char* a) { return published(names_between(before, site(d, a)).renamed_axes); };
    EXPECT_EQ(axes_of(drives, axes), "");
    EXPECT_EQ(axes_of(drives, R"({"name":"z","drive":"d","channel":1},{"name":"y","drive":"e","channel":1})"), "x>z ");
    EXPECT_EQ(axes_of(drives, R"({"name":"z","drive":"d","channel":2},{"name":"y","drive":"e","channel":1})"), "") << "another channel";
    EXPECT_EQ(axes_of(drives, R"({"name":"z","drive":"f","channel":1},{"name":"y","drive":"e","channel":1})"), "") << "another drive";
    EXPECT_EQ(axes_of(drives, R"({"name":"x","drive":"e","channel":1},{"name":"y","drive":"d","channel":1})"), "")
        << "both names are there: drives were exchanged";
    EXPECT_EQ(axes_of(drives,
                      R"({"name":"x","drive":"d","channel":1},{"name":"y","drive":"e","channel":1},{"name":"z","drive":"f","channel":1})"),
              "");
    const auto change = names_between(before, site(R"({"name":"D","line":"l","address":5},{"name":"e","line":"l","address":6})",
                                                   R"({"name":"X","drive":"D","channel":1})"));
    EXPECT_EQ(published(change.renamed_drives), "d>D ");
    EXPECT_EQ(published(change.renamed_axes), "x>X ") << "also when the drive gets another name along with it";
    ASSERT_EQ(change.axes->size(), 1u);
    EXPECT_EQ(change.axes->at(0).family, "demo");
    EXPECT_TRUE(names_between({}, before).renamed_axes.empty());
}

TEST(WaitingBackup, TellsWhatItIsAndCanBeTakenAway) {
    const TempDir dir, other;
    {
        const auto store = open_store(other);
        must(store->save_site("one", "x", 1));
        must(store->save_site("two", "x", 1));
        must(store->backup(other / "backup"));
    }
    const auto options = options_for(dir.path());
    const std::string good = content_of(other / "backup");
    EXPECT_FALSE(waiting_backup(dir.path()));
    EXPECT_EQ(cancel_waiting_backup(dir.path()), "none");
    EXPECT_EQ(lay_down_backup(good, "", "anna", 1234, options).fault, "");
    auto w = waiting_backup(dir.path());
    ASSERT_TRUE(w);
    EXPECT_EQ(w->who, "anna");
    EXPECT_EQ(w->at_unix_ns, 1234);
    EXPECT_EQ(w->bytes, good.size());
    EXPECT_EQ(w->site_revision, 2u);
    EXPECT_EQ(w->version, static_cast<int>(program_migrations().size()));
    for (const auto& wrong : {good.substr(0, 6000), good.substr(0, 100) + std::string(20000, 'x'), std::string(good.size(), '\0')}) {
        const auto [fault, no_room, note] = lay_down_backup(wrong, "", "bert", 5, options);
        EXPECT_NE(fault, "");
        EXPECT_FALSE(no_room) << fault;
        EXPECT_EQ(fault.find(dir.path()), std::string::npos) << fault;
        EXPECT_EQ(fault.find('/'), std::string::npos) << fault;
        EXPECT_EQ(waiting_backup(dir.path())->who, "anna") << "what waited still does";
    }
    std::filesystem::remove(dir / "restore-at-start.json");
    w = waiting_backup(dir.path());
    ASSERT_TRUE(w) << "what was laid down by an older program";
    EXPECT_EQ(w->version, 0);
    EXPECT_GT(w->at_unix_ns, 1234);
    EXPECT_EQ(cancel_waiting_backup(dir.path()), "");
    EXPECT_FALSE(waiting_backup(dir.path()));
    EXPECT_EQ(names_in(dir.path()), std::vector<std::string>{});
    EXPECT_EQ(lay_down_backup(good, "", "anna", 1234, options).fault, "");
    EXPECT_EQ(take_waiting_backup(options), "");
    EXPECT_FALSE(waiting_backup(dir.path()));
    EXPECT_EQ(must(open_store(dir)->load_site())->text, "two");
}

}  // namespace
}  // namespace axisgate::test
