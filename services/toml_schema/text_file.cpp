#include "services/toml_schema/text_file.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <iterator>
#include <system_error>

namespace spindrift {
namespace {

Unexpected unreadable(const std::filesystem::path& path, std::string_view reason) {
  return Unexpected{{ErrorCode::InvalidConfiguration,
                     fmt::format("{}: cannot be read: {}", path.string(), reason)}};
}

}  // namespace

Expected<std::string> read_text_file(const std::filesystem::path& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (failure) {
    return unreadable(path, failure.message());
  }
  if (!std::filesystem::is_regular_file(status)) {
    return unreadable(path, "not a file");
  }
  std::ifstream file{path, std::ios::binary};
  if (!file) {
    return unreadable(path, std::generic_category().message(errno));
  }
  std::string text{std::istreambuf_iterator<char>{file}, {}};
  if (file.bad()) {
    return unreadable(path, "reading failed");
  }
  return text;
}

Expected<std::string> sha256_hex(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    return Unexpected{{ErrorCode::Unavailable, "OpenSSL does not give a SHA-256 digest"}};
  }
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += fmt::format("{:02x}", digest.at(i));
  }
  return hex;
}

}  // namespace spindrift
