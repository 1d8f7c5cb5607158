// A map by source and id, and the order of the results, by which the oldest is forgotten.
#include "gateway/doors/dds/commands_seen.hpp"

namespace axisgate::dds {

void CommandsSeen::forget(const std::string& key) {
    const auto it = kept_.find(key);
    if (it == kept_.end()) return;
    if (const auto held = held_.find(it->second.writer); held != held_.end() && --held->second == 0) held_.erase(held);
    kept_.erase(it);
}

CommandsSeen::Seen CommandsSeen::begin(const std::string& source, const std::string& id, Instant now, std::uint64_t writer) {
    while (!ended_.empty() && now - ended_.front().first >= keep_for) {
        forget(ended_.front().second);
        ended_.pop_front();
    }
    std::string key = key_of(source, id);
    if (const auto it = kept_.find(key); it != kept_.end())
        return it->second.answered ? Seen{Stage::answered, &it->second.result} : Seen{Stage::under_way, nullptr};
    if (kept_.size() >= most) return {Stage::no_room, nullptr};
    const auto held = held_.find(writer);
    if (writer != 0 && held != held_.end() && held->second >= share && most - kept_.size() <= kept_for_others)
        return {Stage::no_room, nullptr};
    Kept kept;
    kept.writer = writer;
    kept_.emplace(std::move(key), std::move(kept));
    ++held_[writer];
    return {};
}

void CommandsSeen::end(const std::string& source, const std::string& id, Result result, Instant now) {
    std::string key = key_of(source, id);
    const auto it = kept_.find(key);
    if (it == kept_.end() || it->second.answered) return;
    it->second.answered = true;
    it->second.result = std::move(result);
    ended_.emplace_back(now, std::move(key));
}

}  // namespace axisgate::dds
