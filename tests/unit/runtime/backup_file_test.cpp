// A backup is read as it was written; each altered byte, each truncation and each wrong passphrase is reported, and nothing is restored
// then.
#include "gateway/runtime/backup_file.hpp"

#include <sys/stat.h>

#include "gateway/runtime/backup_plan.hpp"
#include "gateway/runtime/restore_note.hpp"
#include "gateway/runtime/sealed.hpp"
#include "gateway/runtime/tar.hpp"
#include "gateway/runtime/waiting_backup.hpp"
#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using FaultKind = BackupFault::Kind;
using testing::HasSubstr;
using testing::Not;

const std::string passphrase = "four words nobody guesses";

class TextSink final : public ByteSink {
public:
    BackupResult<> write(std::string_view bytes) override {
        text += bytes;
        return {};
    }
    std::string text;
};

FaultKind kind_of(const std::string& bytes, std::string* words = nullptr) {
    TextSource from(bytes);
    const auto r = read_backup(from, {});
    if (r) return FaultKind{99};
    EXPECT_NE(r.error().text, "");
    if (words) *words = r.error().text;
    return r.error().kind;
}

std::string sealed(std::string_view text, const std::string& with = passphrase) {
    TextSink to;
    auto s = Sealer::begin(to, with, {1, 64});
    EXPECT_TRUE(s && (*s)->write(text) && (*s)->finish());
    return to.text;
}
/// The text, or the fault's kind as a number, with its text.
std::string unsealed(const std::string& bytes, const std::string& with = passphrase, std::size_t at_once = 100'000) {
    TextSource from(bytes);
    auto s = Unsealer::begin(from, with);
    std::string text, part(at_once, '\0');
    while (s) {
        const auto n = (*s)->read(part);
        if (!n) return std::to_string(static_cast<int>(n.error().kind)) + n.error().text;
        text.append(part, 0, *n);
        if (*n < part.size()) return text;
    }
    return std::to_string(static_cast<int>(s.error().kind)) + s.error().text;
}
std::string says(FaultKind kind) { return std::to_string(static_cast<int>(kind)); }

class BackupFileTest : public testing::Test {
protected:
    BackupFileTest() {
        write_file(dir_ / "a.db", std::string(1000, 'd'));
        write_file(dir_ / "key", "a key");
        write_file(dir_ / "toml", "");
        TextSink to;
        BackupContents c{"1.2.3", "hall", 1'700'000'000, {}, {{"recordings", "they stay"}}};
        EXPECT_TRUE(write_backup(to, c, members_));
        archive_ = to.text;
    }
    /// As write_backup makes them, with deliberate faults.
    static std::string archive_of(const std::string& contents, std::string_view database = "db", bool sums = true) {
        Tar tar;
        tar.add("backup.json", contents, 5);
        tar.add("axisgate.db", database, 5);
        if (sums) tar.add("backup.sha256", "0", 5);
        return std::move(tar).finish();
    }

    TempDir dir_;
    std::vector<BackupMember> members_{{"axisgate.db", dir_ / "a.db"}, {"tls-key.pem", dir_ / "key"}, {"axisgate.toml", dir_ / "toml"}};
    std::string archive_;
};

TEST_F(BackupFileTest, WhatIsPutInComesOutForThisUserAlone) {
    TextSource from(archive_);
    const std::string folder = dir_ / "out";
    const auto r = read_backup(from, folder);
    ASSERT_TRUE(r) << r.error().text;
    EXPECT_EQ(r->program, "1.2.3");
    EXPECT_EQ(r->host, "hall");
    EXPECT_EQ(r->made_at_unix_s, 1'700'000'000);
    EXPECT_THAT(r->members, testing::ElementsAre("axisgate.db", "tls-key.pem", "axisgate.toml"));
    EXPECT_THAT(r->left_out, testing::ElementsAre(testing::Pair("recordings", "they stay")));
    EXPECT_EQ(content_of(folder + "/axisgate.db"), std::string(1000, 'd'));
    EXPECT_EQ(content_of(folder + "/tls-key.pem"), "a key");
    EXPECT_EQ(content_of(folder + "/axisgate.toml"), "");
    struct stat st {};
    ASSERT_EQ(::stat((folder + "/tls-key.pem").c_str(), &st), 0);
    EXPECT_EQ(st.st_mode & 07777, 0600u);
    EXPECT_EQ(backup_form_of(archive_), BackupForm::archive);
    TextSource again(archive_);
    const auto there = read_backup(again, folder);
    ASSERT_FALSE(there) << "a folder that is there is not written into";
    EXPECT_EQ(there.error().kind, FaultKind::cannot_write);
}

TEST_F(BackupFileTest, EachByteThatIsAlteredIsFound) {
    for (std::size_t i = 0; i < archive_.size(); ++i) {
        std::string wrong = archive_;
        wrong[i] = static_cast<char>(wrong[i] ^ 1);
        const auto kind = kind_of(wrong);
        ASSERT_TRUE(kind == FaultKind::damaged || kind == FaultKind::newer) << "byte " << i;
    }
    std::string words;
    const std::size_t at = archive_.find("a key");
    std::string wrong = archive_;
    wrong[at] = 'A';
    EXPECT_EQ(kind_of(wrong, &words), FaultKind::damaged);
    EXPECT_THAT(words, HasSubstr("tls-key.pem")) << "which one it is";
}

TEST_F(BackupFileTest, EachCutAndWhatIsAddedIsFound) {
    for (std::size_t n = 0; n < archive_.size(); n += n < 2000 ? 1 : 97)
        ASSERT_EQ(kind_of(archive_.substr(0, n)), FaultKind::damaged) << n;
    EXPECT_EQ(kind_of(archive_.substr(0, archive_.size() - 1)), FaultKind::damaged);
    EXPECT_EQ(kind_of(archive_ + '\0'), FaultKind::damaged);
}

TEST_F(BackupFileTest, WhatNoBackupHasIsRefusedBeforeAnythingIsWritten) {
    const std::string head = R"({"kind":"axisgate backup","form":1,"program":"9","left_out":[],"members":)";
    for (const std::string& members :
         {std::string("[]"), std::string(R"([{"name":"../../etc/passwd","bytes":2}])"),
          std::string(R"([{"name":"tls-key.pem","bytes":2}])"),
          std::string(R"([{"name":"axisgate.db","bytes":2},{"name":"axisgate.db","bytes":2}])"),
          std::string(R"([{"name":"axisgate.db","bytes":-2}])"), std::string(R"([{"name":"axisgate.db","bytes":99999999999}])"),
          std::string(R"([{"name":"axisgate.db","bytes":3}])"), std::string("7"), std::string("[7]"),
          std::string(R"([{"name":"axisgate.db","bytes":2},{"name":"tls-key.pem","bytes":9999999}])")}) {
        EXPECT_EQ(kind_of(archive_of(head + members + "}")), FaultKind::damaged) << members;
    }
    const std::string good = head + R"([{"name":"axisgate.db","bytes":2}]})";
    std::string words;
    EXPECT_EQ(kind_of(archive_of(good), &words), FaultKind::damaged) << "checksums of nothing";
    EXPECT_EQ(kind_of(archive_of(good, "db", false)), FaultKind::damaged);
    EXPECT_EQ(kind_of(archive_of(R"({"kind":"axisgate backup","form":2,"program":"9.9"})"), &words), FaultKind::newer);
    EXPECT_THAT(words, HasSubstr("9.9"));
    EXPECT_EQ(kind_of(archive_of(R"({"kind":"something else","form":1})")), FaultKind::damaged);
    EXPECT_EQ(kind_of(archive_of("[")), FaultKind::damaged);
    EXPECT_EQ(backup_form_of("PK\x03\x04"), BackupForm::none);
    EXPECT_EQ(backup_form_of(""), BackupForm::none);
}

TEST_F(BackupFileTest, AMemberThatIsMissingOrTooLargeMakesNone) {
    TextSink to;
    members_.push_back({"tls-cert.pem", dir_ / "nothing"});
    auto r = write_backup(to, {}, members_);
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error().kind, FaultKind::cannot_read);
    EXPECT_THAT(r.error().text, HasSubstr("nothing"));
    write_file(dir_ / "nothing", std::string((1U << 20) + 1, 'x'));
    EXPECT_FALSE(write_backup(to, {}, members_));
}

TEST(Sealed, WhatIsSealedComesOutInAnyPieces) {
    for (const std::size_t n : {0U, 1U, 65535U, 65536U, 65537U, 200'000U}) {
        std::string text(n, '\0');
        for (std::size_t i = 0; i < n; ++i)
            text[i] = static_cast<char>(i * 7 + i / 251);
        const std::string file = sealed(text);
        EXPECT_EQ(backup_form_of(file), BackupForm::sealed);
        EXPECT_EQ(file.find("AXISGATE-SEALED", 1), std::string::npos);
        EXPECT_TRUE(unsealed(file) == text) << n;
        if (n == 65537) EXPECT_TRUE(unsealed(file, passphrase, 1000) == text);
    }
    EXPECT_NE(sealed("same"), sealed("same")) << "each has a salt of its own";
}

TEST(Sealed, AWrongPassphraseIsToldAsThatAndDamageAsThat) {
    const std::string file = sealed(std::string(70'000, 'x'));
    EXPECT_THAT(unsealed(file, "four words somebody guesses"), testing::StartsWith(says(FaultKind::passphrase_wrong)));
    EXPECT_THAT(unsealed(file, passphrase + "\n"), testing::StartsWith(says(FaultKind::passphrase_wrong)));
    EXPECT_THAT(unsealed(file, ""), testing::StartsWith(says(FaultKind::passphrase_needed)));
    EXPECT_THAT(unsealed(file, std::string(2000, 'x')), testing::StartsWith(says(FaultKind::passphrase_wrong)));
    const auto damaged = testing::StartsWith(says(FaultKind::damaged));
    constexpr std::size_t header = 16 + 1 + 1 + 4 + 16 + 16 + 24 + 16;
    for (const std::size_t at : {std::size_t{17}, std::size_t{18}, std::size_t{30}, std::size_t{40}, std::size_t{60}, std::size_t{80},
                                 header, header + 65'552, header + 65'553, file.size() - 1}) {
        std::string wrong = file;
        wrong[at] = static_cast<char>(wrong[at] ^ 1);
        EXPECT_THAT(unsealed(wrong), damaged) << at;
    }
    for (const std::size_t n : {std::size_t{20}, header - 1, header, header + 10, header + 65'553, header + 65'560, file.size() - 1})
        EXPECT_THAT(unsealed(file.substr(0, n)), damaged) << n;
    EXPECT_THAT(unsealed(file + "x"), damaged);
    // The second chunk alone, and the chunks in another order.
    EXPECT_THAT(unsealed(file.substr(0, header) + file.substr(header + 65'553)), damaged);
    std::string newer = file;
    newer[16] = 2;
    EXPECT_THAT(unsealed(newer), testing::StartsWith(says(FaultKind::newer)));
}

TEST(Sealed, APassphraseThatIsEasilyGuessedSealsNothing) {
    for (const auto* weak : {"", "short", "aaaaaaaaaaaaaaaa", "password1234"}) {
        TextSink to;
        const auto s = Sealer::begin(to, weak);
        ASSERT_FALSE(s) << weak;
        EXPECT_EQ(s.error().kind, FaultKind::passphrase_unfit);
        EXPECT_THAT(s.error().text, HasSubstr("passphrase"));
        EXPECT_EQ(to.text, "");
    }
}

class LaidDown : public testing::Test {
protected:
    LaidDown() {
        const auto store = open_store(options_for(plan_.data_dir));
        must(store->save_site("one", "x", 1));
        write_file(plan_.data_dir + "/http-cert.pem", "certificate");
        write_file(plan_.data_dir + "/http-key.pem", "its key");
        write_file(plan_.tls_key, "another key");
    }
    std::string made(const BackupOrder& order) {
        const auto r = make_backup(plan_, order, from_ / "b");
        EXPECT_TRUE(r) << r.error().text;
        left_out_ = r ? r->left_out : decltype(left_out_){};
        return content_of(from_ / "b");
    }
    TempDir from_, dir_;
    BackupPlan plan_{from_ / "data", "", "", from_ / "key.pem", ""};
    StoreOptions options_ = options_for(dir_.path());
    decltype(BackupContents::left_out) left_out_;
};

TEST_F(LaidDown, ASealedOneWaitsAndTakesItsPlaceWithTheCertificateOfOurOwnMaking) {
    const std::string bytes = made({passphrase, true});
    EXPECT_THAT(names_in(from_.path()), testing::UnorderedElementsAre("b", "data", "key.pem")) << "no part is left";
    EXPECT_THAT(lay_down_backup(bytes, "", "anna", 5, options_).fault, HasSubstr("sealed"));
    EXPECT_THAT(lay_down_backup(bytes, passphrase + "!", "anna", 5, options_).fault, HasSubstr("passphrase is wrong"));
    std::string wrong = bytes;
    wrong[wrong.size() / 2] = static_cast<char>(wrong[wrong.size() / 2] ^ 4);
    const auto reported = lay_down_backup(wrong, passphrase, "anna", 5, options_);
    EXPECT_FALSE(reported.no_room);
    EXPECT_THAT(reported.fault, HasSubstr("altered"));
    EXPECT_THAT(names_in(dir_.path()), testing::IsEmpty()) << "nothing of what was refused is left";
    const auto good = lay_down_backup(bytes, passphrase, "anna", 5, options_);
    EXPECT_EQ(good.fault, "");
    EXPECT_THAT(good.note, HasSubstr("tls-key.pem"));
    ASSERT_TRUE(waiting_backup(dir_.path()));
    EXPECT_EQ(waiting_backup(dir_.path())->site_revision, 1u);
    EXPECT_EQ(take_waiting_backup(options_), "");
    EXPECT_EQ(content_of(dir_ / "http-key.pem"), "its key");
    EXPECT_EQ(content_of(dir_ / "http-cert.pem"), "certificate");
    EXPECT_EQ(must(open_store(dir_)->load_site())->text, "one");
    const auto told = take_restore_note(dir_.path());
    ASSERT_TRUE(told) << "an event says what has happened, whatever the events of the backup say";
    EXPECT_EQ(told->kind, "restore");
    EXPECT_EQ(told->who, "anna");
    EXPECT_NE(told->at_unix_ns, 0);
    EXPECT_EQ(told->old_value, "") << "there was no database";
    EXPECT_EQ(told->new_value, "1");
    EXPECT_THAT(told->text, HasSubstr("token was taken back"));
    EXPECT_FALSE(take_restore_note(dir_.path())) << "told once";
    EXPECT_THAT(names_in(dir_.path()), Not(testing::Contains(HasSubstr("restore")))) << "nothing of it is left";
}

TEST_F(LaidDown, InTheOpenWithoutKeysThePairThatIsThereStays) {
    const std::string bytes = made({"", false});
    EXPECT_EQ(bytes.find("its key"), std::string::npos);
    EXPECT_EQ(bytes.find("another key"), std::string::npos);
    EXPECT_THAT(left_out_, testing::Contains(testing::Pair("http-key.pem", HasSubstr("sealed"))));
    write_file(dir_ / "http-key.pem", "mine");
    EXPECT_EQ(lay_down_backup(bytes, "", "anna", 5, options_).fault, "");
    EXPECT_EQ(take_waiting_backup(options_), "");
    EXPECT_EQ(content_of(dir_ / "http-key.pem"), "mine");
    EXPECT_FALSE(std::filesystem::exists(dir_ / "http-cert.pem"));
}

TEST_F(LaidDown, WhileAnotherGatewayServesTheDirectoryItGoesOnWaiting) {
    const auto serving = open_store(dir_);
    EXPECT_EQ(lay_down_backup(made({"", false}), "", "anna", 5, options_).fault, "");
    EXPECT_THAT(take_waiting_backup(options_), HasSubstr("in use"));
    EXPECT_TRUE(waiting_backup(dir_.path())) << "it is the other one's";
    EXPECT_THAT(names_in(dir_.path()), Not(testing::Contains(HasSubstr("refused"))));
}

TEST_F(LaidDown, WhatIsAlteredWhileItWaitsIsKeptAside) {
    EXPECT_EQ(lay_down_backup(made({"", false}), "", "anna", 5, options_).fault, "");
    std::string bytes = content_of(dir_ / "restore-at-start.db");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_file(dir_ / "restore-at-start.db", bytes);
    EXPECT_THAT(take_waiting_backup(options_), HasSubstr(".refused"));
    EXPECT_FALSE(waiting_backup(dir_.path()));
    EXPECT_EQ(take_waiting_backup(options_), "") << "the next start goes on without it";
}

TEST_F(LaidDown, AFileThatTheConfigurationNamesAndNobodyCanReadMakesNoBackup) {
    write_file(from_ / "b", "the one before");
    plan_.tls_cert = from_ / "gone.pem";
    const auto r = make_backup(plan_, {}, from_ / "b");
    ASSERT_FALSE(r);
    EXPECT_THAT(r.error().text, HasSubstr("gone.pem"));
    EXPECT_EQ(content_of(from_ / "b"), "the one before");
    EXPECT_THAT(names_in(from_.path()), Not(testing::Contains(HasSubstr(".part"))));
}

}  // namespace
}  // namespace axisgate::test
