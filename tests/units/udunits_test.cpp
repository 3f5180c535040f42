#include <dlfcn.h>
#include <doctest/doctest.h>

#include <map>
#include <string>

#include "udar/units/quantity.hpp"
#include "udar/units/unit_table.hpp"

// There under AddressSanitizer only.
extern "C" {
__attribute__((weak)) void __lsan_disable();
__attribute__((weak)) void __lsan_enable();
}

namespace udar {
namespace {

/// UDUNITS leaks what its unit database is made of; that is no fault of ours.
struct LeaksAllowed {
  LeaksAllowed() {
    if (__lsan_disable != nullptr) __lsan_disable();
  }
  ~LeaksAllowed() {
    if (__lsan_enable != nullptr) __lsan_enable();
  }
  LeaksAllowed(const LeaksAllowed&) = delete;
  LeaksAllowed& operator=(const LeaksAllowed&) = delete;
};

/// UDUNITS as an oracle, loaded if it is there: the build does not depend on it.
class Udunits {
 public:
  Udunits() : library_(dlopen("libudunits2.so.0", RTLD_NOW)) {
    if (library_ == nullptr) return;
    void* (*quiet)(void*) = nullptr;
    void* (*set_handler)(void*) = nullptr;
    load(quiet, "ut_ignore");
    load(set_handler, "ut_set_error_message_handler");
    set_handler(reinterpret_cast<void*>(quiet));
    void* (*read)(const char*) = nullptr;
    load(read, "ut_read_xml");
    load(parse_, "ut_parse");
    load(converter_, "ut_get_converter");
    load(convert_, "cv_convert_double");
    load(free_unit_, "ut_free");
    load(free_converter_, "cv_free");
    load(free_system_, "ut_free_system");
    system_ = read(nullptr);
  }
  ~Udunits() {
    if (system_ != nullptr) free_system_(system_);
    if (library_ != nullptr) dlclose(library_);
  }
  Udunits(const Udunits&) = delete;
  Udunits& operator=(const Udunits&) = delete;

  [[nodiscard]] bool found() const { return system_ != nullptr; }

  /// How many `to` one `from` is; 0 where the library knows no such unit.
  [[nodiscard]] double factor(const std::string& from, const std::string& to) const {
    constexpr int ascii = 0;
    void* a = parse_(system_, from.c_str(), ascii);
    void* b = parse_(system_, to.c_str(), ascii);
    void* converter = a != nullptr && b != nullptr ? converter_(a, b) : nullptr;
    const double out = converter != nullptr ? convert_(converter, 1) : 0;
    if (converter != nullptr) free_converter_(converter);
    if (a != nullptr) free_unit_(a);
    if (b != nullptr) free_unit_(b);
    return out;
  }

 private:
  template <class Function>
  void load(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(library_, name));
    const bool loaded = function != nullptr;
    REQUIRE(loaded);
  }

  void* library_;
  void* system_ = nullptr;
  void* (*parse_)(void*, const char*, int) = nullptr;
  void* (*converter_)(void*, void*) = nullptr;
  double (*convert_)(void*, double) = nullptr;
  void (*free_unit_)(void*) = nullptr;
  void (*free_converter_)(void*) = nullptr;
  void (*free_system_)(void*) = nullptr;
};

TEST_CASE("units have the sizes that UDUNITS gives them") {
  const LeaksAllowed leaks_allowed;
  const Udunits udunits;
  if (!udunits.found()) {
    MESSAGE("UDUNITS is not installed; nothing was compared");
    return;
  }
  // What it calls by another name, or not at all (ours in its words).
  const std::map<std::string, std::string> other_words{{"psi", "lbf/in^2"},
                                                       {"ksi", "kip/in^2"},
                                                       {"kip", "1000 lbf"},
                                                       {"deg", "arc_degree"},
                                                       {"rev", "360 arc_degree"},
                                                       {"tf", "1000 kgf"},
                                                       {"rpm", "6 arc_degree/s"},
                                                       {"in", "inch"},
                                                       {"mi", "mile"},
                                                       {"yd", "yard"},
                                                       {"at", "kgf/cm^2"},
                                                       {"lbm", "lb"}};
  int compared = 0;
  for (const std::string& name : unit_names()) {
    const auto unit = find_unit(name);
    REQUIRE(unit.has_value());
    const auto other = other_words.find(name);
    const std::string si = unit->dimension == dimension::number ? "1" : si_unit(unit->dimension);
    const double factor = udunits.factor(other == other_words.end() ? name : other->second, si);
    INFO(name);
    if (factor == 0) continue;
    ++compared;
    CHECK(unit->scale.apply(1) == doctest::Approx(factor).epsilon(1e-12));
  }
  CHECK(compared > 60);
  for (const char* text :
       {"kgf/cm^2", "kg/m^3", "m/s^2", "N/mm^2", "lbf/in", "g/cm^3", "kg m^2/s^3", "N/(m s)", "m s-2", "kN/m"}) {
    const auto ours = parse_quantity("1 " + std::string(text));
    REQUIRE(ours.has_value());
    CHECK(ours->value == doctest::Approx(udunits.factor(text, si_unit(ours->dimension))).epsilon(1e-12));
  }
}

}  // namespace
}  // namespace udar
