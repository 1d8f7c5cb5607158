// Fuzz: a backup that somebody sends: a good database with the fuzzer's changes in it, or anything at all.
// In: the fuzzer's bytes: changes (place, byte), a cut, or the file itself. Out: nothing; laws: it is taken or refused in words, and what
// was there before is untouched by a refusal.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "gateway/core/assets.hpp"
#include "gateway/store/backup.hpp"
#include "gateway/store/store.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;
namespace fs = std::filesystem;

namespace {

struct Ground {
    fs::path folder = fs::temp_directory_path() / ("axisgate-fuzz-" + std::to_string(::getpid()));
    std::string good;
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
    std::string file = ground.good;
    if (in.ConsumeIntegralInRange<int>(0, 7) == 0) {
        file = "SQLite format 3";
        file += '\0';
        file += in.ConsumeRemainingBytesAsString();
    } else {
        if (in.ConsumeIntegralInRange<int>(0, 7) == 0) file.resize(in.ConsumeIntegralInRange<std::size_t>(0, file.size()));
        for (int n = 0; n < 64 && in.remaining_bytes() >= 3 && !file.empty(); ++n) {
            const auto place = in.ConsumeBool() ? in.ConsumeIntegralInRange<std::size_t>(0, std::min<std::size_t>(file.size() - 1, 200))
                                                : in.ConsumeIntegralInRange<std::size_t>(0, file.size() - 1);
            file[place] = static_cast<char>(in.ConsumeIntegral<std::uint8_t>());
        }
    }
    const fs::path sent = ground.folder / "sent.db", kept = fs::path(ground.options.directory) / "axisgate.db";
    std::ofstream(sent, std::ios::binary | std::ios::trunc) << file;
    const std::string before = Ground::read(kept);
    const auto report = restore_database(sent.string(), ground.options);
    if (!report.has_value()) {
        require(!report.error().text.empty(), "a refusal has words");
        require(Ground::read(kept) == before, "what is refused changes nothing");
        return 0;
    }
    auto store = Store::open(ground.options);
    require(store.has_value() || !store.error().text.empty(), "what was taken can be opened, or says why not");
    if (!report->kept.empty()) fs::remove(report->kept);
    return 0;
}
