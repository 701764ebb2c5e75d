// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prodomos/mapper/report.hpp"

namespace prodomos::mapper {

namespace {

void save(base::ByteWriter& out, const std::map<std::string, std::int64_t>& counts) {
  out << static_cast<std::uint64_t>(counts.size());
  for (const auto& [name, count] : counts) out << name << count;
}

void load(base::ByteReader& in, std::map<std::string, std::int64_t>& counts) {
  counts.clear();
  for (auto left = in.read<std::uint64_t>(); left > 0; --left) {
    const auto name = in.read<std::string>();
    counts[name] = in.read<std::int64_t>();
  }
}

}  // namespace

void Report::addFault(const std::string& fault) {
  ++faultCount;
  if (faults.size() < kMostFaults) faults.push_back(fault);
}

void Report::save(base::ByteWriter& out) const {
  out << read << used << faultCount << submaps << distance << lost;
  mapper::save(out, usedByKind);
  mapper::save(out, skippedByReason);
  mapper::save(out, notLookedAt);
  mapper::save(out, refused);
  out << static_cast<std::uint64_t>(faults.size());
  for (const auto& fault : faults) out << fault;
}

void Report::load(base::ByteReader& in) {
  in >> read >> used >> faultCount >> submaps >> distance >> lost;
  mapper::load(in, usedByKind);
  mapper::load(in, skippedByReason);
  mapper::load(in, notLookedAt);
  mapper::load(in, refused);
  faults.clear();
  for (auto left = in.read<std::uint64_t>(); left > 0; --left) faults.push_back(in.read<std::string>());
}

}  // namespace prodomos::mapper
