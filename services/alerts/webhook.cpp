#include "services/alerts/webhook.h"

#include <curl/curl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "pipelines/core/shown.h"
#include "services/alerts/firing_alerts.h"
#include "services/base/contained.h"
#include "services/base/every.h"
#include "services/base/wall_clock.h"
#include "services/base/warning.h"

namespace spindrift {
namespace {

constexpr std::chrono::seconds kPeriod{1};
constexpr long kTimeOut_ms = 5000;
constexpr long kOk = 200;
constexpr long kRedirect = 300;

struct Cleanup {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};

std::size_t discard(const char* /*text*/, std::size_t size, std::size_t count, void* /*self*/) {
  return size * count;
}

Expected<void> check(const std::string& url) {
  const std::unique_ptr<CURLU, Cleanup> parts{curl_url()};
  const bool known = url.starts_with("http://") || url.starts_with("https://");
  if (!known || curl_url_set(parts.get(), CURLUPART_URL, url.c_str(), 0) != CURLUE_OK) {
    return Unexpected{
        {ErrorCode::InvalidConfiguration, fmt::format("--webhook {}: must be a URL, as "
                                                      "http://127.0.0.1:9093/api/v2/alerts",
                                                      shown(url))}};
  }
  return {};
}

/// @return Unavailable when the server does not accept the body.
Expected<void> post(const std::string& url, const std::string& body) {
  const std::unique_ptr<CURL, Cleanup> handle{curl_easy_init()};
  const std::unique_ptr<curl_slist, Cleanup> headers{
      curl_slist_append(nullptr, "Content-Type: application/json")};
  if (!handle || !headers) {
    return Unexpected{{ErrorCode::Unavailable, "out of memory"}};
  }
  curl_easy_setopt(handle.get(), CURLOPT_URL, url.c_str());
  curl_easy_setopt(handle.get(), CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle.get(), CURLOPT_NOPROXY, "*");
  curl_easy_setopt(handle.get(), CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(handle.get(), CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body.size()));
  curl_easy_setopt(handle.get(), CURLOPT_POSTFIELDS, body.data());
  curl_easy_setopt(handle.get(), CURLOPT_WRITEFUNCTION, &discard);
  curl_easy_setopt(handle.get(), CURLOPT_TIMEOUT_MS, kTimeOut_ms);
  curl_easy_setopt(handle.get(), CURLOPT_NOSIGNAL, 1L);
  if (const CURLcode code = curl_easy_perform(handle.get()); code != CURLE_OK) {
    return Unexpected{{ErrorCode::Unavailable, curl_easy_strerror(code)}};
  }
  long status = 0;
  curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &status);
  if (status < kOk || status >= kRedirect) {
    return Unexpected{{ErrorCode::Unavailable, fmt::format("it answers with status {}", status)}};
  }
  return {};
}

}  // namespace

Expected<std::unique_ptr<Webhook>> Webhook::start(const std::string& url, const AlertDesk& desk,
                                                  const std::string& service) {
  return check(url).map([&] { return std::unique_ptr<Webhook>{new Webhook{url, desk, service}}; });
}

Webhook::Webhook(std::string url, const AlertDesk& desk, std::string service)
    : url_{std::move(url)},
      desk_{desk},
      service_{std::move(service)},
      thread_{[this](const std::stop_token& stop) {
        if (const auto ended = contained("the webhook", [&] { run(stop); }); !ended) {
          warn("no_webhook", {{"why", ended.error().message}}, ended.error().message);
        }
      }} {}

Webhook::~Webhook() = default;

BackOff Webhook::deliveries() const {
  const std::lock_guard lock{mutex_};
  return deliveries_;
}

void Webhook::note(const Expected<void>& sent) {
  const std::lock_guard lock{mutex_};
  if (sent) {
    deliveries_.succeed();
  } else {
    deliveries_.fail(std::chrono::steady_clock::now());
  }
}

void Webhook::run(const std::stop_token& stop) {
  FiringAlerts firing{service_};
  std::string failure;  // Last logged failure.
  every(kPeriod, stop, [&] {
    if (!deliveries().is_due(std::chrono::steady_clock::now())) {
      return;
    }
    const nlohmann::json due = firing.due(desk_.open(), tai_now());
    if (due.empty()) {
      note({});  // What it has not taken is over.
      return;
    }
    const auto sent =
        post(url_, due.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    note(sent);
    if (sent) {
      firing.told(tai_now());
      if (!std::exchange(failure, "").empty()) {
        spdlog::info("the webhook {} takes alerts again", url_);
      }
    } else if (std::exchange(failure, sent.error().message) != sent.error().message) {
      warn("webhook_fails", {{"url", url_}, {"why", failure}, {"alerts", due.size()}},
           fmt::format("{} alerts wait, the webhook {} does not take them: {}", due.size(), url_,
                       failure));
    }
  });
}

}  // namespace spindrift
