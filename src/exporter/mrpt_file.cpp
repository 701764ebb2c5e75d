// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause
#include "exporter/mrpt_file.hpp"

#include "prodomos/base/error.hpp"

#include "exporter/write_file.hpp"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/io/zip.h>
#include <mrpt/serialization/CArchive.h>

#include <string_view>
#include <vector>

namespace prodomos::exporter {

void writeMrptFile(const std::filesystem::path& path, const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << object;
  const auto* plain = static_cast<const std::uint8_t*>(stream.getRawBufferData());
  std::vector<std::uint8_t> packed;
  if (!mrpt::io::zip::compress_gz_data_block({plain, plain + stream.getTotalBytesCount()}, packed, 6)) {
    throw base::FileError(path.string() + ": cannot be compressed");
  }
  writeFile(path, {reinterpret_cast<const char*>(packed.data()), packed.size()});
}

}  // namespace prodomos::exporter
