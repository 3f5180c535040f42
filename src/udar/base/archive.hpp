#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "udar/base/compensated_sum.hpp"
#include "udar/base/error.hpp"
#include "udar/base/vec2.hpp"

namespace udar {

/// Values as bytes and back, by one description for both ways. A type that is to be kept says what it consists of:
///
///     template <class Archive>
///     void carry(Archive& archive) { archive(begin, end, impulse); }
///
/// Numbers keep their bits; the bytes are those of a little-endian machine.

/// Kept as its bytes: every pattern of bits is a value, and none of it is padding.
template <class T>
concept PlainBytes = (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) || std::is_same_v<T, Vec2> ||
                     std::is_same_v<T, CompensatedSum>;

/// Puts values into bytes.
class BytesOut {
 public:
  static constexpr bool reads = false;

  template <class... T>
  void operator()(T&... values) {
    (put(values), ...);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  template <PlainBytes T>
  void put(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(bool& value) { bytes_.push_back(value ? '\1' : '\0'); }
  void put(std::string& text) {
    put(std::uint64_t{text.size()});
    bytes_ += text;
  }
  template <class T>
  void put(std::optional<T>& value) {
    bool there = value.has_value();
    put(there);
    if (value) put(*value);
  }
  template <class T>
  void put(std::vector<T>& values) {
    put(std::uint64_t{values.size()});
    if constexpr (PlainBytes<T>) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    } else {
      for (T& value : values) put(value);
    }
  }
  template <class T>
  requires(!PlainBytes<T>) void put(T& value) { value.carry(*this); }

  std::string bytes_;
};

/// Takes values out of bytes in the order in which they were put in. No count is believed before the bytes for it are
/// there. Throws OutputError where the bytes end too early.
class BytesIn {
 public:
  static constexpr bool reads = true;

  explicit BytesIn(std::string_view bytes) : rest_(bytes) {}
  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  /// Refuses bytes that nobody took.
  void finish() const {
    if (!rest_.empty()) throw OutputError("there is more in it than belongs there");
  }

 private:
  std::string_view take(std::uint64_t count) {
    if (count > rest_.size()) throw OutputError("it ends too early");
    const std::string_view piece = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return piece;
  }
  std::uint64_t count_of(std::size_t smallest) {
    std::uint64_t count = 0;
    get(count);
    if (count > rest_.size() / smallest) throw OutputError("it ends too early");
    return count;
  }
  template <PlainBytes T>
  void get(T& value) {
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }
  void get(bool& value) { value = take(1).front() != '\0'; }
  void get(std::string& text) { text = take(count_of(1)); }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) get(value.emplace());
  }
  template <class T>
  void get(std::vector<T>& values) {
    if constexpr (PlainBytes<T>) {
      values.resize(count_of(sizeof(T)));
      const std::string_view bytes = take(values.size() * sizeof(T));
      if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    } else {
      values.clear();
      for (std::uint64_t left = count_of(1); left > 0; --left) get(values.emplace_back());
    }
  }
  template <class T>
  requires(!PlainBytes<T>) void get(T& value) { value.carry(*this); }

  std::string_view rest_;
};

}  // namespace udar
