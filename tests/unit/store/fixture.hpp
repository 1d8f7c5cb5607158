// What the store's tests share: a directory of their own, the program's migrations, results that fail a test with their text.
// In: nothing. Out: opened stores. Never leaves files behind.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/store/backup.hpp"
#include "gateway/store/store.hpp"

namespace axisgate::test {

using Kind = StoreError::Kind;

/// The value of a result; a failure of the test with the error's text if there is none.
template <class T>
T must(StoreResult<T> r) {
    if (r) {
        if constexpr (std::is_void_v<T>) {
            return;
        } else {
            return std::move(*r);
        }
    }
    ADD_FAILURE() << "[" << name_of(r.error().kind) << "] " << r.error().text;
    if constexpr (!std::is_void_v<T>) return T{};
}
/// The error of a result; a failure of the test if it went well.
template <class T>
StoreError refused(const StoreResult<T>& r) {
    if (!r) return r.error();
    ADD_FAILURE() << "went well, but must not";
    return {};
}

class TempDir {
public:
    TempDir() {
        std::string pattern = (std::filesystem::temp_directory_path() / "axisgate-store-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ~TempDir() {
        std::error_code ec;
        std::filesystem::remove_all(path_, ec);
    }
    TempDir(const TempDir&) = delete;
    TempDir& operator=(const TempDir&) = delete;
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

inline std::vector<Migration> program_migrations() { return must(migrations_among(all_assets())); }

inline StoreOptions options_for(const std::string& directory) {
    StoreOptions o;
    o.directory = directory;
    o.migrations = program_migrations();
    return o;
}

inline std::unique_ptr<Store> open_store(const StoreOptions& options) {
    auto r = Store::open(options);
    if (r) return std::move(*r);
    ADD_FAILURE() << "[" << name_of(r.error().kind) << "] " << r.error().text;
    return nullptr;
}
inline std::unique_ptr<Store> open_store(const TempDir& dir) { return open_store(options_for(dir.path())); }

inline std::string content_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_file(const std::string& file, std::string_view content) {
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    out << content;
}
/// Name -> content of all files but those that SQLite uses as shared memory and the lock.
inline std::map<std::string, std::string> content_of_directory(const std::string& directory) {
    std::map<std::string, std::string> all;
    for (const auto& e : std::filesystem::directory_iterator(directory)) {
        const std::string name = e.path().filename().string();
        if (!name.ends_with("-shm") && !name.ends_with(".lock")) all[name] = content_of(e.path().string());
    }
    return all;
}
inline std::vector<std::string> names_in(const std::string& directory) {
    std::vector<std::string> names;
    for (const auto& e : std::filesystem::directory_iterator(directory))
        names.push_back(e.path().filename().string());
    return names;
}

/// A write of an integer, with everything else filled in from `at`.
inline ParameterWrite a_write(std::string axis, std::string parameter, Value value, std::int64_t at = 1'000) {
    ParameterWrite w;
    w.axis = std::move(axis);
    w.parameter = std::move(parameter);
    w.value = std::move(value);
    w.door = http::clients;
    w.who = "192.0.2.7:51123";
    w.at_unix_ns = at;
    w.storage = "eeprom";
    return w;
}
inline Event an_event(std::string kind, std::string axis, std::int64_t at, Severity severity = Severity::info) {
    Event e;
    e.at_unix_ns = at;
    e.severity = severity;
    e.kind = std::move(kind);
    e.axis = std::move(axis);
    e.text = "something happened";
    return e;
}
inline StoreResult<> commit_one(Store& store, const ParameterWrite& w) { return store.commit(std::span(&w, 1)); }

/// Runs SQL on a database file as another program would. `leave_log`: ends as by a crash, its changes still in the log.
inline void meddle(const std::string& file, const std::string& sql, bool leave_log = false) {
    auto db = must(Db::open(file, Db::Mode::read_write));
    must(db->exec(sql.c_str()));
    if (!leave_log) sqlite3_db_config(db->handle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 0, nullptr);
}

}  // namespace axisgate::test
