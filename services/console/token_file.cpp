#include "services/console/token_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "services/operator/request_socket.h"

namespace spindrift {
namespace {

constexpr std::size_t kTokenBytes = 32;
// Limit for tokens chosen by a person.
constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLongestFile = 1024;

Unexpected failed(const std::filesystem::path& file, std::string_view what) {
  return Unexpected{{ErrorCode::Unavailable, fmt::format("token {}: {}: {}", file.string(), what,
                                                         std::generic_category().message(errno))}};
}

Expected<std::string> make(const std::filesystem::path& file) {
  std::array<unsigned char, kTokenBytes> random{};
  if (RAND_bytes(random.data(), random.size()) != 1) {
    return Unexpected{{ErrorCode::Unavailable, "token: OpenSSL gives no random numbers"}};
  }
  std::string token;
  for (const unsigned char byte : random) {
    token += fmt::format("{:02x}", byte);
  }
  const Descriptor out{
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR)};
  const std::string line = token + "\n";
  if (!out.is_open() ||
      ::write(out.number(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    return failed(file, "cannot be made");
  }
  return token;
}

Expected<std::string> read(const std::filesystem::path& file, const Descriptor& in) {
  struct stat status {};
  std::string text(kLongestFile, '\0');
  const ssize_t length = ::fstat(in.number(), &status) == 0
                             ? ::read(in.number(), text.data(), text.size())
                             : ssize_t{-1};
  if (length < 0) {
    return failed(file, "cannot be read");
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration,
         fmt::format("token {}: others can read it: chmod 600, or remove it: the next "
                     "start makes another",
                     file.string())}};
  }
  text.resize(static_cast<std::size_t>(length));
  text.erase(text.find_last_not_of(" \r\n") + 1);
  if (text.size() < kShortestToken) {
    return Unexpected{{ErrorCode::InvalidConfiguration,
                       fmt::format("token {}: has fewer than {} characters: remove it: the next "
                                   "start makes another",
                                   file.string(), kShortestToken)}};
  }
  return text;
}

}  // namespace

Expected<std::string> token_of(const std::filesystem::path& archive) {
  const std::filesystem::path file = archive.string() + ".token";
  const Descriptor in{::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (in.is_open()) {
    return read(file, in);
  }
  return errno == ENOENT ? make(file) : failed(file, "cannot be read");
}

bool is_same_token(std::string_view token, std::string_view given) {
  return token.size() == given.size() &&
         CRYPTO_memcmp(token.data(), given.data(), token.size()) == 0;
}

}  // namespace spindrift
