#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "udar/results/verification.hpp"

namespace udar {

/// The manual of a verification: every problem with its page, its checks and its pictures.
struct VerificationFiles {
  static constexpr const char* data = "verify.json";
  static constexpr const char* markdown = "verification.md";
  static constexpr const char* page = "verification.html";  ///< one file, without scripts
  static constexpr const char* pictures = "pictures";       ///< folder of verification-PROBLEM-N.svg, for the Markdown
};

/// Refuses a folder that holds something else than an earlier verification, or one unless `force`. Throws UserError
/// (usage).
void check_verification_folder(const std::filesystem::path& folder, bool force);

/// Writes all of them; files of an earlier verification are replaced, other folders refused. Throws UserError as above,
/// and OutputError.
void write_verification(const std::filesystem::path& folder, const Verification& verification);

/// The page, for a browser.
std::string verification_html(const Verification& verification);

/// The manual as Markdown of docs/verification.md: links lead to other pages there, pictures to pictures/.
std::string verification_markdown(const Verification& verification);

}  // namespace udar
