// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "map/database.hpp"

namespace prodomos::map {

/// The version of the map file's tables, in PRAGMA user_version.
constexpr int kSchemaVersion = 3;
/// "prdm", in PRAGMA application_id: tells a map from other SQLite files.
constexpr int kApplicationId = 0x7072646D;

/// Makes all tables in an empty database.
void createSchema(const Database& database);
/// Throws base::FileError where the file is no map or of a newer schema.
void checkSchema(const Database& database);
/// Brings the tables of an older map up to this version, in one transaction.
void upgradeSchema(const Database& database);
/// What an older version does not have is NULL in queries.
bool hasCovariances(const Database& database);
bool hasPredictions(const Database& database);
bool tracksHaveEntities(const Database& database);

}  // namespace prodomos::map
