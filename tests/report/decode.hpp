#pragma once

#include <doctest/doctest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "udar/report/arrays.hpp"

/// Reads what report/ writes, written from docs/report-format.md alone.

inline std::string from_base64(std::string_view text) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6) | static_cast<std::uint32_t>(letters.find(c));
    held += 6;
    if (held >= 8) out += static_cast<char>((bits >> (held -= 8)) & 0xFFU);
  }
  return out;
}

inline std::string inflated(const std::string& packed, std::size_t size) {
  std::string out(size + 1, '\0');  // one more, so that too many are seen
  z_stream stream{};
  REQUIRE(inflateInit2(&stream, -MAX_WBITS) == Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  CHECK(inflate(&stream, Z_FINISH) == Z_STREAM_END);
  CHECK(stream.avail_in == 0);
  out.resize(out.size() - stream.avail_out);
  inflateEnd(&stream);
  return out;
}

/// The whole numbers of a table, row by row.
inline std::vector<std::uint32_t> decoded_numbers(const nlohmann::json& array, std::string_view text) {
  const std::size_t rows = array.at("rows");
  const std::size_t columns = array.at("columns");
  const std::size_t bytes = array.at("bytes");
  const std::size_t count = rows * columns;
  const std::uint64_t modulus = std::uint64_t{1} << (8 * bytes);
  const std::string planes = inflated(from_base64(text), count * bytes);
  REQUIRE(planes.size() == count * bytes);
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t row = 0; row < rows; ++row) {
    std::uint64_t difference = 0;
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = row * columns + column;
      std::uint64_t code = 0;
      for (std::size_t b = 0; b < bytes; ++b) {
        code += std::uint64_t{static_cast<unsigned char>(planes[b * count + i])} << (8 * b);
      }
      const std::uint64_t r = code % 2 == 0 ? code / 2 : modulus - (code + 1) / 2;
      difference = (difference + r) % modulus;
      const std::uint64_t above = row > 0 ? numbers[i - columns] : 0;
      numbers[i] = static_cast<std::uint32_t>((above + difference) % modulus);
    }
  }
  return numbers;
}

inline std::vector<double> decoded(const nlohmann::json& array, std::string_view text) {
  std::vector<double> out;
  for (const std::uint32_t q : decoded_numbers(array, text)) {
    if (array.value("float", false)) {
      out.push_back(std::bit_cast<float>(q));
    } else if (array.contains("none") && array.at("none") == q) {
      out.push_back(std::numeric_limits<double>::quiet_NaN());
    } else if (array.contains("low")) {
      out.push_back(array.at("low").get<double>() + array.at("step").get<double>() * q);
    } else {
      out.push_back(q);
    }
  }
  return out;
}

/// A report taken apart.
struct ReadReport {
  explicit ReadReport(std::string_view html) {
    constexpr std::string_view open = "<script type=\"application/json\" id=\"run\">";
    run = nlohmann::json::parse(element(html, open));
    for (std::size_t b = 0;; ++b) {
      const std::string tag = "<script type=\"text/plain\" id=\"block-" + std::to_string(b) + "\">";
      if (html.find(tag) == std::string_view::npos) break;
      blocks.emplace_back(element(html, tag));
    }
  }
  static std::string_view element(std::string_view html, std::string_view open) {
    const std::size_t begin = html.find(open);
    REQUIRE(begin != std::string_view::npos);
    const std::size_t end = html.find("</script>", begin);
    REQUIRE(end != std::string_view::npos);
    return html.substr(begin + open.size(), end - begin - open.size());
  }
  [[nodiscard]] std::vector<double> values(const nlohmann::json& array) const {
    return decoded(array, blocks.at(array.at("block").get<std::size_t>()));
  }
  [[nodiscard]] const nlohmann::json* quantity(std::string_view name) const {
    for (const auto& q : run.at("quantities")) {
      if (q.at("name") == name) return &q;
    }
    return nullptr;
  }

  nlohmann::json run;
  std::vector<std::string> blocks;
};
