// Fuzz target for an uploaded backup: a good database, archive or sealed archive with changes of the fuzzer (place, byte, a cut), or any
// bytes. Laws: it is accepted or refused with a text, a changed archive is refused, a refusal leaves the former state, and an accepted
// backup is restored by the next start.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "gateway/core/assets.hpp"
#include "gateway/runtime/backup_file.hpp"
#include "gateway/runtime/sealed.hpp"
#include "gateway/runtime/waiting_backup.hpp"
#include "gateway/store/backup.hpp"
#include "gateway/store/store.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;
namespace fs = std::filesystem;

namespace {

const std::string passphrase = "four words nobody guesses";

class Bytes final : public ByteSink {
public:
    BackupResult<> write(std::string_view bytes) override {
        text += bytes;
        return {};
    }
    std::string text;
};

struct Ground {
    fs::path folder = fs::temp_directory_path() / ("axisgate-fuzz-" + std::to_string(::getpid()));
    std::string good, archive, sealed;
    StoreOptions options;
    Ground() {
        fs::create_directories(folder);
        auto migrations = migrations_among(all_assets());
        require(migrations.has_value(), "the migrations can be read");
        options.directory = (folder / "var").string();
        options.migrations = std::move(*migrations);
        {
            auto store = Store::open(options);
            require(store.has_value(), "a new store can be made");
            require((*store)->save_site("{}", "fuzz", 1).has_value(), "and written");
            require((*store)->backup((folder / "good.db").string()).has_value(), "and copied");
        }
        good = read(folder / "good.db");
        std::ofstream(folder / "key") << "a key";
        const std::vector<BackupMember> members{{"axisgate.db", (folder / "good.db").string()}, {"tls-key.pem", (folder / "key").string()}};
        Bytes open, shut;
        require(write_backup(open, {"1", "fuzz", 5, {}, {{"recordings", "so"}}}, members).has_value(), "an archive can be made");
        auto sealer = Sealer::begin(shut, passphrase, {1, 8});
        require(sealer.has_value() && (*sealer)->write(open.text).has_value() && (*sealer)->finish().has_value(), "and sealed");
        archive = open.text, sealed = shut.text;
    }
    ~Ground() { fs::remove_all(folder); }
    static std::string read(const fs::path& p) {
        std::ifstream f(p, std::ios::binary);
        return {std::istreambuf_iterator<char>(f), {}};
    }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Ground ground;
    if (size < 2 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    const int form = in.ConsumeIntegralInRange<int>(0, 3);
    const std::string& whole = form == 0 ? ground.archive : form == 1 ? ground.sealed : ground.good;
    std::string file = whole;
    if (in.ConsumeIntegralInRange<int>(0, 7) == 0) {
        file = form == 0 ? ground.archive.substr(0, 512) : form == 1 ? std::string(sealed_magic) : std::string("SQLite format 3\0", 16);
        file += in.ConsumeRemainingBytesAsString();
    } else {
        if (in.ConsumeIntegralInRange<int>(0, 7) == 0) file.resize(in.ConsumeIntegralInRange<std::size_t>(0, file.size()));
        for (int n = 0; n < 64 && in.remaining_bytes() >= 3 && !file.empty(); ++n) {
            const auto place = in.ConsumeBool() ? in.ConsumeIntegralInRange<std::size_t>(0, std::min<std::size_t>(file.size() - 1, 1600))
                                                : in.ConsumeIntegralInRange<std::size_t>(0, file.size() - 1);
            file[place] = static_cast<char>(in.ConsumeIntegral<std::uint8_t>());
        }
    }
    const fs::path kept = fs::path(ground.options.directory) / "axisgate.db";
    const std::string before = Ground::read(kept);
    const auto outcome = lay_down_backup(file, passphrase, "fuzz", 1, ground.options);
    require(Ground::read(kept) == before, "what is laid down changes nothing yet");
    require(waiting_backup(ground.options.directory).has_value() == outcome.fault.empty(), "it waits if it was good, and only then");
    if (!outcome.fault.empty()) return 0;
    require(form > 1 || file == whole, "an archive is taken as it was made or not at all");
    require(take_waiting_backup(ground.options).empty(), "what was found good is taken");
    auto store = Store::open(ground.options);
    require(store.has_value() || !store.error().text.empty(), "what was taken can be opened, or says why not");
    fs::remove(kept.string() + ".replaced-1");
    return 0;
}
