#include "services/telemetry/telemetry_files.h"

#include <sys/stat.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/matchers.h"
#include "tests/support/outcome.h"
#include "tests/support/read_telemetry.h"
#include "tests/support/temporary_folder.h"

namespace spindrift::telemetry_files_test {

Expected<std::vector<TelemetryFile>> scan(std::vector<std::filesystem::path> paths) {
  return scan_telemetry(paths);
}

std::string error_of(std::vector<std::filesystem::path> paths) {
  const auto files = scan_telemetry(paths);
  if (files) {
    return "no error";
  }
  EXPECT_EQ(files.error().code, ErrorCode::InvalidConfiguration);
  return files.error().message;
}

struct TelemetryFiles : ::testing::Test {
  const TemporaryFolder folder;
};

TEST_F(TelemetryFiles, AreRecognisedByTheirHeaders) {
  const std::array<std::pair<const char*, TelemetryKind>, 7> cases = {
      {{"t_tai_ns,channel\n", Kind<Pulse>{}},
       {"t_tai_ns,period_s,sun2_s,north_in_s,north_out_s,south_in_s,south_out_s\n",
        Kind<CodedFrame>{}},
       {"t_tai_ns,wx_rad_s,wy_rad_s,wz_rad_s\n", Kind<GyroSample>{}},
       {"t_tai_ns,qx,qy,qz,qw\n", Kind<StarFix>{}},
       {"t_tai_ns,sx,sy,sz\n", Kind<SunDirection>{}},
       {"t_tai_ns,bx_nt,by_nt,bz_nt\n", Kind<MagneticField>{}},
       {"t_tai_ns,x_km,y_km,z_km,vx_km_s,vy_km_s,vz_km_s\n", Kind<TimedOrbitState>{}}}};
  for (const auto& [header, kind] : cases) {
    SCOPED_TRACE(header);
    const auto files = value_or_throw(scan({folder.write("a.csv", header)}));
    ASSERT_EQ(files.size(), 1U);
    EXPECT_EQ(files.front().kind, kind);
  }
}

TEST_F(TelemetryFiles, MayNameTheSpacecraftInAnyColumn) {
  for (const char* header : {"spacecraft,t_tai_ns,channel", "t_tai_ns,spacecraft,channel",
                             "t_tai_ns,channel,spacecraft"}) {
    SCOPED_TRACE(header);
    const auto files = value_or_throw(scan({folder.write("a.csv", header)}));
    EXPECT_EQ(files.front().kind, TelemetryKind{Kind<Pulse>{}});
  }
}

TEST_F(TelemetryFiles, OfADirectoryAreItsCsvFilesByName) {
  folder.write("b.csv", "t_tai_ns,channel\n");
  folder.write("a.csv", kCodedHeader);
  folder.write("notes.txt", "not telemetry");
  folder.write("a.csv.bak", "not telemetry");
  std::filesystem::create_directory(folder.path() / "c.csv");
  const auto files = value_or_throw(scan({folder.path()}));
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].path, folder.path() / "a.csv");
  EXPECT_EQ(files[0].kind, TelemetryKind{Kind<CodedFrame>{}});
  EXPECT_EQ(files[1].path, folder.path() / "b.csv");
  EXPECT_EQ(files[1].kind, TelemetryKind{Kind<Pulse>{}});
}

TEST_F(TelemetryFiles, StayInTheOrderGiven) {
  const auto z = folder.write("z.csv", "t_tai_ns,channel\n");
  const auto a = folder.write("a.csv", "t_tai_ns,channel\n");
  const auto files = scan({z, a}).value();
  EXPECT_EQ(files[0].path, z);
  EXPECT_EQ(files[1].path, a);
}

TEST_F(TelemetryFiles, WithAnUnknownHeaderAreRefusedNamingFileLineAndWhatIsAllowed) {
  for (const char* header : {"time,channel", "t_tai_ns", "t_tai_ns,channel,extra",
                             "channel,t_tai_ns", "t_tai_ns, channel", "T_TAI_NS,CHANNEL",
                             "spacecraft,t_tai_ns,channel,spacecraft", ",", "\xff\xfe"}) {
    SCOPED_TRACE(header);
    const auto path = folder.write("odd.csv", std::string{"\n"} + header + "\n1,sun1\n");
    EXPECT_THAT(error_of({path}),
                AllOf(HasSubstr(path.string() + ":2: header \""),
                      HasSubstr("\"t_tai_ns,channel\" (pulses)"),
                      HasSubstr("\"t_tai_ns,bx_nt,by_nt,bz_nt\" (magnetometer)")));
  }
}

TEST_F(TelemetryFiles, WithoutAHeaderAreRefused) {
  for (const char* text : {"\n\r\n\n", "\xEF\xBB\xBF"}) {
    const auto path = folder.write("empty.csv", text);
    EXPECT_THAT(error_of({path}),
                HasSubstr(path.string() + ": is empty: must begin with a header"));
  }
}

TEST_F(TelemetryFiles, WithoutAByteAreOfNoKind) {
  const std::vector<std::filesystem::path> paths = {folder.write("empty.csv", "")};
  const auto files = value_or_throw(scan_telemetry(paths));
  EXPECT_EQ(files.front().kind, std::nullopt);
}

TEST_F(TelemetryFiles, ThatCannotBeReadAreNamedAllAtOnce) {
  const auto odd = folder.write("odd.csv", "what,is,this\n");
  const auto good = folder.write("good.csv", "t_tai_ns,channel\n");
  const auto nothing = folder.path() / "nothing.csv";
  const auto bare = folder.path() / "bare";
  std::filesystem::create_directory(bare);
  const std::string error = error_of({odd, good, nothing, bare});
  EXPECT_THAT(error, AllOf(HasSubstr(odd.string() + ":1: header \"what,is,this\""),
                           HasSubstr(nothing.string() + ": cannot be read: No such file"),
                           HasSubstr(bare.string() + ": there is no *.csv in this directory")));
  EXPECT_THAT(error, Not(HasSubstr(good.string())));
}

TEST_F(TelemetryFiles, ThatAreNoRegularFilesAreRefusedInsteadOfReadForEver) {
  const auto pipe = folder.path() / "pipe.csv";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(error_of({pipe, "/dev/zero"}), pipe.string() +
                                               ": cannot be read: not a regular file\n" +
                                               "/dev/zero: cannot be read: not a regular file");
}

TEST_F(TelemetryFiles, AreSourcesByAsMuchOfTheirPathAsTellsThemApart) {
  constexpr const char* kHeader = "t_tai_ns,qx,qy,qz,qw\n";
  for (const char* name : {"a", "a/one", "b", "b/one"}) {
    std::filesystem::create_directory(folder.path() / name);
  }
  const auto files =
      scan({folder.write("a/one/star.csv", kHeader), folder.write("b/one/star.csv", kHeader),
            folder.write("b/star.csv", kHeader), folder.write("b/other.csv", kHeader)})
          .value();
  const std::array<std::string, 4> expected{"a/one/star.csv", "b/one/star.csv", "b/star.csv",
                                            "other.csv"};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(files[i].source, expected.at(i));
    EXPECT_EQ(find_source(files, expected.at(i)), expected.at(i));
    EXPECT_EQ(find_source(files, files[i].path.string()), expected.at(i));
  }
  EXPECT_EQ(find_source(files, "star.csv"), "");
  EXPECT_EQ(find_source(files, "one/star.csv"), "");
  EXPECT_EQ(find_source(files, "x/other.csv"), "");
  EXPECT_EQ(find_source(files, "b"), "");
}

}  // namespace spindrift::telemetry_files_test
