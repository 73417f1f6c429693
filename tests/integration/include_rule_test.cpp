// Include rules of pipelines/ and services/. Link lines alone do not enforce them, since every
// target sees the whole source tree.

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/support/test_paths.h"
#include "tests/support/text_of.h"

namespace spindrift::include_rule_test {

struct Source {
  std::string folder;
  std::string name;
  std::string text;
  std::vector<std::string> includes;  ///< Paths as written between quotes or brackets.

  std::string path() const { return folder + "/" + name; }
};

std::vector<std::string> includes_of(const std::string& text) {
  constexpr std::string_view kInclude = "#include ";
  std::vector<std::string> includes;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kInclude)) {
      const auto end = line.find_first_of("\">", kInclude.size() + 1);
      includes.push_back(line.substr(kInclude.size() + 1, end - kInclude.size() - 1));
    }
  }
  return includes;
}

std::vector<Source> sources_of(const std::filesystem::path& root) {
  std::vector<Source> sources;
  for (const char* top : {"pipelines", "services"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator{root / top}) {
      const auto kind = entry.path().extension();
      if (kind == ".h" || kind == ".cpp") {
        std::string text = text_of(entry.path());
        std::vector<std::string> includes = includes_of(text);
        sources.push_back({.folder = entry.path().parent_path().lexically_relative(root).string(),
                           .name = entry.path().filename().string(),
                           .text = std::move(text),
                           .includes = std::move(includes)});
      }
    }
  }
  std::ranges::sort(sources, {}, &Source::path);
  return sources;
}

/// Maps each folder to the folders it includes, each with a line that says where.
using Uses = std::map<std::string, std::map<std::string, std::string>>;

Uses uses_of(const std::vector<Source>& sources) {
  Uses uses;
  for (const Source& source : sources) {
    for (const std::string& include : source.includes) {
      const std::string folder = std::filesystem::path{include}.parent_path().string();
      if ((folder.starts_with("pipelines/") || folder.starts_with("services/")) &&
          folder != source.folder) {
        uses[source.folder].try_emplace(folder, source.path() + " includes " + include);
      }
    }
  }
  return uses;
}

/// Returns the include lines that lead from `path`'s last folder back to one of `path`; empty if
/// there are none.
std::vector<std::string> cycle_from(const Uses& uses, std::vector<std::string>& path,
                                    std::set<std::string>& done) {
  const auto used = uses.find(path.back());
  if (used == uses.end() || done.contains(path.back())) {
    return {};
  }
  for (const auto& [folder, line] : used->second) {
    if (const auto again = std::ranges::find(path, folder); again != path.end()) {
      std::vector<std::string> lines;
      for (auto at = again; std::next(at) != path.end(); ++at) {
        lines.push_back(uses.at(*at).at(*std::next(at)));
      }
      lines.push_back(line);
      return lines;
    }
    path.push_back(folder);
    if (auto lines = cycle_from(uses, path, done); !lines.empty()) {
      return lines;
    }
    path.pop_back();
  }
  done.insert(path.back());
  return {};
}

/// Returns one cycle of folders that include each other, a line for each step; empty if there is
/// none.
std::vector<std::string> first_cycle(const std::vector<Source>& sources) {
  const Uses uses = uses_of(sources);
  std::set<std::string> done;
  for (const auto& [folder, used] : uses) {
    std::vector<std::string> path{folder};
    if (auto lines = cycle_from(uses, path, done); !lines.empty()) {
      return lines;
    }
  }
  return {};
}

bool touches_the_world(std::string_view include) {
  static const std::set<std::string_view> headers = {
      "spindrift.h",  "sqlite3.h",  "atomic",  "condition_variable",
      "ctime",        "filesystem", "fstream", "future",
      "iostream",     "latch",      "mutex",   "semaphore",
      "shared_mutex", "stop_token", "thread",  "cstdio",
      "stdio.h",      "sys/time.h", "time.h",  "unistd.h"};
  static const std::vector<std::string_view> folders = {"services/", "idl/", "dds/", "SQLiteCpp/",
                                                        "spdlog/"};
  return headers.contains(include) || std::ranges::any_of(folders, [include](const auto& folder) {
           return include.starts_with(folder);
         });
}

/// Returns the includes of operating-system headers and the uses of clocks in pipelines/.
std::vector<std::string> world_in_pipelines(const std::vector<Source>& sources) {
  std::vector<std::string> found;
  for (const Source& source : sources) {
    if (!source.folder.starts_with("pipelines")) {
      continue;
    }
    for (const std::string& include : source.includes) {
      if (touches_the_world(include)) {
        found.push_back(source.path() + " includes " + include);
      }
    }
    for (const char* clock : {"system_clock", "steady_clock", "high_resolution_clock"}) {
      if (source.text.find(clock) != std::string::npos) {
        found.push_back(source.path() + " names " + clock);
      }
    }
  }
  return found;
}

TEST(IncludeRule, NoFoldersIncludeEachOtherInACircle) {
  EXPECT_THAT(first_cycle(sources_of(source_folder())), IsEmpty());
}

TEST(IncludeRule, PipelinesIncludeNothingOfTheWorld) {
  EXPECT_THAT(world_in_pipelines(sources_of(source_folder())), IsEmpty());
}

/// Holds a source tree that obeys all rules, so that each test can break one.
class MadeUpTree : public ::testing::Test {
 protected:
  MadeUpTree() {
    add("pipelines/core/value.h", "#include <cmath>\n");
    add("pipelines/spin/fix/axis.h", "#include \"pipelines/core/value.h\"\n");
    add("pipelines/spin/mean/mean.cpp", "#include \"pipelines/spin/fix/axis.h\"\n");
    add("services/bus/reader.h", "#include <dds/dds.h>\n#include \"pipelines/core/value.h\"\n");
    add("services/ingest/subscriber.h", "#include \"services/bus/reader.h\"\n");
  }
  void add(const std::filesystem::path& path, const std::string& text) const {
    std::filesystem::create_directories((tree_.path() / path).parent_path());
    tree_.write(path, text);
  }
  std::vector<Source> sources() const { return sources_of(tree_.path()); }

 private:
  TemporaryFolder tree_;
};

using IncludeRuleOf = MadeUpTree;

TEST_F(IncludeRuleOf, AHealthyTreeIsKept) {
  EXPECT_THAT(first_cycle(sources()), IsEmpty());
  EXPECT_THAT(world_in_pipelines(sources()), IsEmpty());
}

TEST_F(IncludeRuleOf, ACircleIsNamedWithItsFiles) {
  add("pipelines/core/back.cpp", "#include <vector>\n\n#include \"pipelines/spin/mean/mean.h\"\n");
  EXPECT_THAT(first_cycle(sources()),
              ElementsAre("pipelines/core/back.cpp includes pipelines/spin/mean/mean.h",
                          "pipelines/spin/mean/mean.cpp includes pipelines/spin/fix/axis.h",
                          "pipelines/spin/fix/axis.h includes pipelines/core/value.h"));
}

TEST_F(IncludeRuleOf, ACircleOfServicesAloneIsFound) {
  add("services/bus/writer.cpp", "#include \"services/ingest/subscriber.h\"\n");
  EXPECT_THAT(first_cycle(sources()),
              ElementsAre("services/bus/writer.cpp includes services/ingest/subscriber.h",
                          "services/ingest/subscriber.h includes services/bus/reader.h"));
}

TEST_F(IncludeRuleOf, AFolderMayNotIncludeWhatStandsInItAndUsesIt) {
  add("pipelines/spin/all.h", "#include \"pipelines/spin/fix/axis.h\"\n");
  EXPECT_THAT(first_cycle(sources()), IsEmpty());
  add("pipelines/spin/fix/more.h", "#include \"pipelines/spin/all.h\"\n");
  EXPECT_EQ(first_cycle(sources()).size(), 2U);
}

TEST_F(IncludeRuleOf, EveryPartOfTheWorldIsRefusedToPipelines) {
  for (const std::string include :
       {"\"services/bus/reader.h\"", "<spindrift.h>", "<dds/dds.h>", "<SQLiteCpp/Database.h>",
        "<sqlite3.h>", "<spdlog/spdlog.h>", "<iostream>", "<fstream>", "<filesystem>", "<thread>",
        "<mutex>"}) {
    SCOPED_TRACE(include);
    add("pipelines/core/value.h", "#include " + include + "\n");
#include "tests/support/matchers.h"
    EXPECT_THAT(world_in_pipelines(sources()),
                ElementsAre(HasSubstr("pipelines/core/value.h includes ")));
  }
  add("pipelines/core/value.h", "const auto now = std::chrono::steady_clock::now();\n");
  EXPECT_THAT(world_in_pipelines(sources()),
              ElementsAre("pipelines/core/value.h names steady_clock"));
}

}  // namespace spindrift::include_rule_test
