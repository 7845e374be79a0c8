#include "base/version.h"

#include "base/files.h"

namespace searchlight {
namespace {

TEST(Structure, CitationStatesTheVersionThatIsBuilt) {
    const std::string citation = readFile(SEARCHLIGHT_SOURCE_DIR "/CITATION.cff");
    EXPECT_THAT(citation, testing::HasSubstr("\nversion: " + std::string(version()) + "\n"));
}

}  // namespace
}  // namespace searchlight
