#include "services/base/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace spindrift {
namespace {

constexpr std::size_t kReadAtOnce = std::size_t{256} * 1024;

class Sha256 {
 public:
  bool begin() { return context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1; }

  bool add(std::string_view bytes) {
    return EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1;
  }

  /// Returns an empty string on failure.
  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    std::string hex;
    if (EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1) {
      for (unsigned int i = 0; i < size; ++i) {
        hex += fmt::format("{:02x}", digest.at(i));
      }
    }
    return hex;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  std::unique_ptr<EVP_MD_CTX, Free> context_{EVP_MD_CTX_new()};
};

/// @param next Returns the bytes piece by piece, and an empty piece at the end.
template <class Next>
Expected<std::string> digest_of(const Next& next) {
  const Unexpected refused{{ErrorCode::Unavailable, "OpenSSL does not give a SHA-256 digest"}};
  Sha256 sha256;
  bool taken = sha256.begin();
  while (taken) {
    const Expected<std::string_view> piece = next();
    if (!piece) {
      return Unexpected{piece.error()};
    }
    if (piece->empty()) {
      break;
    }
    taken = sha256.add(*piece);
  }
  std::string hex = taken ? sha256.hex() : std::string{};
  return hex.empty() ? Expected<std::string>{refused} : std::move(hex);
}

}  // namespace

Expected<std::string> sha256_hex(std::string_view bytes) {
  return digest_of([&bytes]() -> Expected<std::string_view> { return std::exchange(bytes, {}); });
}

Expected<std::string> sha256_hex(InputFile& file) {
  std::vector<char> buffer(kReadAtOnce);
  return digest_of([&] {
    return file.read(buffer).map([&buffer](std::size_t count) {
      return std::string_view{buffer.data(), count};
    });
  });
}

Expected<std::string> sha256_hex(std::span<const std::filesystem::path> files) {
  std::vector<char> buffer(kReadAtOnce);
  std::optional<InputFile> open;
  return digest_of([&]() -> Expected<std::string_view> {
    while (open || !files.empty()) {
      if (!open) {
        auto opened = InputFile::open(files.front());
        if (!opened) {
          return Unexpected{opened.error()};
        }
        open = *std::move(opened);
        files = files.subspan(1);
      }
      const auto count = open->read(buffer);
      if (!count) {
        return Unexpected{count.error()};
      }
      if (*count > 0) {
        return std::string_view{buffer.data(), *count};
      }
      open.reset();
    }
    return std::string_view{};
  });
}

}  // namespace spindrift
