#include "udar/results/pvd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "udar/base/error.hpp"
#include "udar/results/file.hpp"
#include "udar/results/xml.hpp"

namespace udar {
namespace {

PvdEntry parse_entry(const XmlTag& tag) {
  PvdEntry entry;
  entry.file = tag.attribute("file");
  const std::string time = tag.attribute("timestep");
  const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), entry.time);
  if (time.empty() || error != std::errc() || end != time.data() + time.size() || !std::isfinite(entry.time)) {
    throw OutputError(fmt::format("`{}` is not a time", time.substr(0, 40)));
  }
  entry.part = static_cast<int>(std::min<std::size_t>(tag.count("part").value_or(0), 1000));
  const std::filesystem::path file(entry.file);
  const bool leads_out = file.is_absolute() || std::find(file.begin(), file.end(), "..") != file.end();
  if (entry.file.empty() || leads_out) throw OutputError("an entry does not name a file inside the run folder");
  return entry;
}

}  // namespace

void PvdIndex::write() const {
  if (entries_.empty()) return;
  FileReplacement file(path_);
  file.write(to_pvd(entries_));
  file.commit_unsynced();
}

std::string to_pvd(const std::vector<PvdEntry>& entries) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  for (const PvdEntry& entry : entries) {
    out += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", entry.time, entry.part,
                       escape_xml(entry.file));
  }
  return out + "</Collection>\n</VTKFile>\n";
}

std::vector<PvdEntry> read_pvd(const std::filesystem::path& path) {
  constexpr std::size_t most_bytes = std::size_t{1} << 26;
  const std::string text = read_file(path, most_bytes);
  try {
    return parse_pvd(text);
  } catch (const OutputError& error) {
    throw OutputError(fmt::format("cannot read {}: {}", path.string(), error.what()));
  }
}

std::vector<PvdEntry> parse_pvd(std::string_view text) {
  std::vector<PvdEntry> entries;
  bool is_collection = false;
  XmlScanner scanner(text);
  while (const std::optional<XmlTag> tag = scanner.next()) {
    if (tag->name == "Collection") is_collection = true;
    if (tag->name == "DataSet" && !tag->closing) entries.push_back(parse_entry(*tag));
  }
  if (!is_collection) throw OutputError("it is not an index of frames");
  return entries;
}

}  // namespace udar
