// `spindrift serve` whose archive is deleted, moved, replaced or truncated during a pass.

#include <spindrift.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/archive_rows.h"
#include "tests/support/eventually.h"
#include "tests/support/matchers.h"
#include "tests/support/on_bus.h"
#include "tests/support/ran.h"
#include "tests/support/recorded_files.h"
#include "tests/support/service.h"
#include "tests/support/subscriber.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_of.h"

namespace spindrift::serve_lost_archive_test {

namespace fs = std::filesystem;

fs::path beside(const fs::path& path, const std::string& suffix) { return path.string() + suffix; }
fs::path log_of(const fs::path& db) { return beside(db, "-wal"); }
fs::path aside(const fs::path& path) { return beside(path, ".aside"); }
fs::path foreign(const fs::path& db) { return db.parent_path() / "foreign"; }

void move_aside(const fs::path& path) { fs::rename(path, aside(path)); }

void write_text(const fs::path& path) { std::ofstream{path} << std::string(10'000, 'x'); }

void put_in_place_of(const fs::path& path, const std::function<void(const fs::path&)>& make) {
  make(foreign(path));
  fs::rename(foreign(path), path);
}

/// Returns the files to which the service has copied its open archive.
std::vector<fs::path> copies_of(const fs::path& db) {
  std::vector<fs::path> copies;
  for (const auto& entry : fs::directory_iterator{db.parent_path()}) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(db.filename().string() + ".rescued-") && name.ends_with("Z")) {
      copies.push_back(entry.path());
    }
  }
  return copies;
}

/// Runs a service with part of a pass, and holds the expected archive of the undisturbed pass.
class ServeLostArchive : public ::testing::Test {
 protected:
  static constexpr double kBefore = 0.4;

  void SetUp() override {
    succeeded(arguments("nominal", offline_));
    front_end_.emplace(service_.bus(), "SPINNER", pulses_in(offline_));
    ASSERT_TRUE(front_end_->send_until(kBefore));
    ASSERT_TRUE(eventually([&] { return count_rows(db(), "spin_fix") > 100; }));
    health_.emplace(service_.bus(), bus::kHealthTopic);
  }

  /// Waits for a heartbeat that contains `words` (or not).
  /// @return False if none comes.
  bool health_says(const std::string& words, bool expected = true) const {
    return eventually([&] {
      bool says = !expected;
      health_->take([&](const spindrift_Health& beat) {
        says = std::string{beat.message}.find(words) != std::string::npos;
      });
      return says == expected;
    });
  }

  /// Returns the number of fixes in the file at the path; 0 if that is not an archive.
  std::int64_t fix_count() const {
    try {
      return count_rows(db(), "spin_fix");
    } catch (const SQLite::Exception&) {
      return 0;
    }
  }

  /// Waits until all but the last three fixes are computed: a stop computes for a few seconds only.
  bool is_computed() const {
    const std::int64_t fixes = count_rows(offline_, "spin_fix");
    return eventually([&] { return fix_count() + 3 >= fixes; });
  }

  void send_the_rest_and_expect_the_whole_pass() {
    ASSERT_TRUE(front_end().send_until(1.0));
    EXPECT_TRUE(is_computed()) << log();
    EXPECT_EQ(service().stop_when_computed(), 0) << log();
    EXPECT_THAT(rows_of(db(), "PRAGMA integrity_check"), ElementsAre("ok|"));
    EXPECT_THAT(rows_of(db(), "PRAGMA foreign_key_check"), IsEmpty());
    EXPECT_EQ(count_rows(db(), "pulse"), 3600);
    EXPECT_EQ(product_rows(db()), product_rows(offline_));
    EXPECT_EQ(last_batch_rows(db()), last_batch_rows(offline_));
    EXPECT_THAT(copies_of(db()), IsEmpty());
  }

  ReadyService& service() { return service_; }
  FrontEnd& front_end() { return *front_end_; }
  fs::path db() const { return service_.db(); }
  const fs::path& offline() const { return offline_; }
  std::string log() { return service_.program().log(); }

 private:
  TemporaryFolder folder_;
  const fs::path offline_ = folder_.path() / "processed.db";
  ReadyService service_{"nominal"};
  std::optional<FrontEnd> front_end_;
  std::optional<Subscriber<spindrift_Health>> health_;
};

struct Loss {
  std::string name;
  std::function<void(const fs::path& db)> happens;
  std::string said;
};

void PrintTo(const Loss& loss, std::ostream* out) { *out << loss.name; }

std::string name_of(const ::testing::TestParamInfo<Loss>& loss) { return loss.param.name; }

/// Losses after which no file has the archive's name.
class ServeArchiveWithoutName : public ServeLostArchive,
                                public ::testing::WithParamInterface<Loss> {};

TEST_P(ServeArchiveWithoutName, IsWrittenThereAgainWithAllThatItHad) {
  GetParam().happens(db());
  EXPECT_TRUE(service().program().says(GetParam().said));
  ASSERT_TRUE(front_end().send_until(0.8));
  EXPECT_TRUE(eventually([&] { return fix_count() > 400; })) << log();
  send_the_rest_and_expect_the_whole_pass();
}

INSTANTIATE_TEST_SUITE_P(
    When, ServeArchiveWithoutName,
    ::testing::Values(Loss{"Deleted", [](const fs::path& db) { fs::remove(db); },
                           "served.db was deleted or moved away"},
                      Loss{"MovedAway", move_aside, "served.db was deleted or moved away"},
                      Loss{"LogDeleted", [](const fs::path& db) { fs::remove(log_of(db)); },
                           "served.db-wal was deleted or moved away"},
                      Loss{"IndexDeleted",
                           [](const fs::path& db) { fs::remove(beside(db, "-shm")); },
                           "served.db-shm was deleted or moved away"},
                      Loss{"AllDeleted",
                           [](const fs::path& db) {
                             for (const char* suffix : {"", "-wal", "-shm", ".lock"}) {
                               fs::remove(beside(db, suffix));
                             }
                           },
                           "served.db was deleted or moved away"}),
    name_of);

/// A loss after which another file has one of the archive's names.
struct Replacement {
  std::string name;
  std::function<void(const fs::path& db, const fs::path& other)> happens;
  std::string of;  ///< Suffix of the replaced file after the archive's name.
};

void PrintTo(const Replacement& replacement, std::ostream* out) { *out << replacement.name; }

class ServeReplacedArchive : public ServeLostArchive,
                             public ::testing::WithParamInterface<Replacement> {
 protected:
  fs::path replaced() const { return beside(db(), GetParam().of); }

  void replace() {
    GetParam().happens(db(), offline());
    content_ = text_of(replaced());
    EXPECT_TRUE(health_says("another file stands at " + replaced().string()));
    ASSERT_TRUE(front_end().send_until(0.8));
  }

  const std::string& content() const { return content_; }

 private:
  std::string content_;
};

TEST_P(ServeReplacedArchive, GoesOnWithAllThatItHadWhenTheOtherFileIsMovedAway) {
  replace();
  EXPECT_EQ(copies_of(db()).size(), 1U);
  move_aside(replaced());
  EXPECT_EQ(text_of(aside(replaced())), content());
  EXPECT_TRUE(health_says("not storing", false));
  send_the_rest_and_expect_the_whole_pass();
  EXPECT_EQ(text_of(aside(replaced())), content());
}

TEST_P(ServeReplacedArchive, EndsAsACopyWhenTheServiceIsStopped) {
  replace();
  EXPECT_EQ(service().stop(), 1);
  EXPECT_THAT(service().program().out(), StartsWith("{\"error\":"));
  const auto copies = copies_of(db());
  ASSERT_EQ(copies.size(), 1U);
  EXPECT_THAT(log(), HasSubstr("rows that were accepted are not in archive " + db().string()));
  EXPECT_THAT(log(), HasSubstr(copies[0].string()));
  EXPECT_EQ(text_of(replaced()), content());
  EXPECT_THAT(rows_of(copies[0], "PRAGMA integrity_check"), ElementsAre("ok|"));
  // SQLite leaves an empty log when its last reader closes, and the service may have opened it.
  EXPECT_EQ(fs::exists(log_of(db())) && fs::file_size(log_of(db())) > 0, GetParam().of == "-wal");
  // The last samples may not have been acknowledged and are sent again.
  fs::rename(replaced(), aside(replaced()));
  fs::rename(copies[0], db());
  service().go_on();
  send_the_rest_and_expect_the_whole_pass();
}

INSTANTIATE_TEST_SUITE_P(
    By, ServeReplacedArchive,
    ::testing::Values(Replacement{"AnotherArchive",
                                  [](const fs::path& db, const fs::path& other) {
                                    put_in_place_of(
                                        db, [&](const fs::path& file) { fs::copy(other, file); });
                                  },
                                  ""},
                      Replacement{"Text",
                                  [](const fs::path& db, const fs::path& /*other*/) {
                                    put_in_place_of(db, write_text);
                                  },
                                  ""},
                      Replacement{"TextAsLog",
                                  [](const fs::path& db, const fs::path& /*other*/) {
                                    put_in_place_of(log_of(db), write_text);
                                  },
                                  "-wal"}),
    [](const auto& replacement) { return replacement.param.name; });

TEST_F(ServeLostArchive, GoesOnWhenTheRightFileIsPutBack) {
  fs::create_hard_link(db(), aside(db()));
  put_in_place_of(db(), write_text);
  EXPECT_TRUE(health_says("another file stands at " + db().string()));
  ASSERT_TRUE(front_end().send_until(0.8));
  fs::rename(aside(db()), db());
  EXPECT_TRUE(health_says("not storing", false));
  send_the_rest_and_expect_the_whole_pass();
}

/// Losses after which the file is the same but its content is damaged.
class ServeDamagedArchive : public ServeLostArchive, public ::testing::WithParamInterface<Loss> {};

TEST_P(ServeDamagedArchive, StoresNothingMoreAndSaysSoAndTheNextStartHasThePass) {
  GetParam().happens(db());
  const std::string content = text_of(db());
  EXPECT_TRUE(health_says("its file was truncated or overwritten"));
  ASSERT_TRUE(front_end().send_until(0.8));
  EXPECT_EQ(service().stop(), 1);
  EXPECT_THAT(log(), HasSubstr("rows that were accepted are not in archive " + db().string()));
  EXPECT_THAT(log(), HasSubstr("start again"));
  EXPECT_THAT(service().program().out(), StartsWith("{\"error\":"));
  EXPECT_EQ(text_of(db()), content);
  EXPECT_TRUE(fs::exists(log_of(db())));

  move_aside(db());
  move_aside(log_of(db()));
  service().go_on();
  send_the_rest_and_expect_the_whole_pass();
}

INSTANTIATE_TEST_SUITE_P(
    When, ServeDamagedArchive,
    ::testing::Values(
        Loss{"Emptied", [](const fs::path& db) { fs::resize_file(db, 0); }, ""},
        Loss{"Halved", [](const fs::path& db) { fs::resize_file(db, fs::file_size(db) / 2); }, ""},
        Loss{"OverwrittenByText", write_text, ""},
        Loss{"OverwrittenByALongerFile",
             [](const fs::path& db) { fs::resize_file(db, fs::file_size(db) + 100'000'000); }, ""}),
    name_of);

TEST_F(ServeLostArchive, IsNotWrittenByTwoWhateverNamesTheyHaveForIt) {
  const fs::path link = beside(db(), ".link");
  fs::create_hard_link(db(), link);
  refused(arguments("nominal", db()), {"is being written by pid"}, 1);
  refused(arguments("nominal", link), {"is being written under another name"}, 1);
  send_the_rest_and_expect_the_whole_pass();
}

}  // namespace spindrift::serve_lost_archive_test
