// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/prediction/refusals.hpp"

namespace prodomos::prediction {

namespace {

constexpr std::string_view kKind = "prediction_refused";
constexpr std::string_view kBefore = R"({"reason":")";  // reasons are plain words
constexpr std::string_view kAfter = R"("})";

}  // namespace

Refusals::Refusals(const map::MapView& before) {
  if (before.sessions().empty() || before.sessions().back().state != map::SessionState::kRunning) return;
  for (const auto& event : before.events()) {
    if (event.kind != kKind || event.session != before.sessions().back().id) continue;
    const auto length = event.payload.size() - kBefore.size() - kAfter.size();
    known_.emplace(event.payload.substr(kBefore.size(), length), event.subject);
  }
}

void Refusals::add(base::EntityId entity, const std::string& reason, const World& world) {
  if (!known_.emplace(reason, toString(entity)).second) return;
  events_.push_back({world.now, world.session, std::string(kKind), toString(entity),
                     std::string(kBefore) + reason + std::string(kAfter)});
}

std::map<std::string, std::int64_t> Refusals::byReason() const {
  std::map<std::string, std::int64_t> counts;
  for (const auto& [reason, entity] : known_) ++counts[reason];
  return counts;
}

void Refusals::addTo(map::MapChange& change) {
  for (auto& event : std::exchange(events_, {})) change.events.push_back(std::move(event));
}

}  // namespace prodomos::prediction
