// The state behind the window: undo, files, the command line that stands for it.
#include <QDir>
#include <QTemporaryDir>
#include <array>
#include <cstdio>
#include <filesystem>
#include <random>

#include "base/error.h"
#include "base/files.h"
#include "gui/state/command_line.h"
#include "gui/state/open_path.h"
#include "gui/state/recovery.h"
#include "gui/state/workspace.h"

namespace searchlight::gui {
namespace {

using testing::HasSubstr;

std::string messageOf(const std::string& text) {
    try {
        parseWorkspace(text, "w.json");
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

// Some of everything that a person changes; the same for the same seed.
void editAtRandom(State& state, std::mt19937& random) {
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    switch (random() % 8) {
        case 0: state.scene.camera.azimuth_deg = number(-180, 180); break;
        case 1: state.scene.material = {.id = "", .sigma_a = {number(0, 1)}, .sigma_s = {1, 2, number(1, 3)}}; break;
        case 2: state.models.push_back(newSlot(state, "single")); break;
        case 3: state.models.back().material = SceneMaterial{.id = "marble"}; break;
        case 4: state.active = static_cast<int>(random() % state.models.size()); break;
        case 5: state.options["view"]["exposure"] = number(-4, 4); break;
        case 6: state.scene.lights.push_back(PointLight{.position = {number(-1, 1), 1, 1}}); break;
        default: state.models.front().model.parameters["Moments"] = std::string("exact"); break;
    }
}

TEST(Workspace, UndoReturnsTheExactState) {
    Workspace workspace;
    std::mt19937 random(7);
    std::vector<std::string> before{workspaceJson(workspace.state())};
    for (int i = 0; i < 60; ++i) {
        workspace.edit(QStringLiteral("step"), {}, [&](State& state) { editAtRandom(state, random); });
        if (workspaceJson(workspace.state()) != before.back()) before.push_back(workspaceJson(workspace.state()));
    }
    const std::vector<std::string> all = before;
    while (workspace.undoStack().canUndo()) {
        before.pop_back();
        workspace.undoStack().undo();
        ASSERT_EQ(workspaceJson(workspace.state()), before.back());
    }
    ASSERT_EQ(before.size(), 1u);
    for (std::size_t i = 1; i < all.size(); ++i) {
        workspace.undoStack().redo();
        ASSERT_EQ(workspaceJson(workspace.state()), all[i]);
    }
}

TEST(Workspace, AGestureIsOneStep) {
    Workspace workspace;
    const auto move = [&](double scale) {
        workspace.edit(QStringLiteral("size"), QStringLiteral("scale"),
                       [&](State& state) { state.scene.scale = scale; });
    };
    for (const double scale : {11.0, 12.0, 13.0}) move(scale);
    workspace.endGesture();
    move(14);
    EXPECT_EQ(workspace.undoStack().count(), 2);
    workspace.undoStack().undo();
    EXPECT_EQ(workspace.state().scene.scale, 13);
}

TEST(Workspace, AnEditThatChangesNothingIsNone) {
    Workspace workspace;
    int changes = 0;
    QObject::connect(&workspace, &Workspace::changed, [&] { ++changes; });
    workspace.edit(QStringLiteral("nothing"), {}, [](State&) {});
    EXPECT_EQ(workspace.undoStack().count(), 0);
    EXPECT_EQ(changes, 0);
}

TEST(Workspace, ChangesAreNamedByTheirParts) {
    const State before = defaultState();
    const auto of = [&](auto&& change) {
        State after = before;
        change(after);
        return difference(before, after);
    };
    EXPECT_TRUE(of([](State&) {}).empty());
    const Change camera = of([](State& state) { state.scene.camera.azimuth_deg += 1; });
    EXPECT_TRUE(camera.has(Part::camera));
    EXPECT_FALSE(camera.any({Part::object, Part::lights, Part::material, Part::models, Part::options}));
    EXPECT_TRUE(of([](State& state) { state.scene.scale = 3; }).has(Part::object));
    EXPECT_TRUE(of([](State& state) { state.models[1].visible = false; }).has(Part::models));
    EXPECT_TRUE(of([](State& state) { state.models[0].material = SceneMaterial{}; }).has(Part::material));
    EXPECT_TRUE(of([](State& state) { state.technique = "brute_force"; }).has(Part::technique));
}

TEST(Workspace, AFileComesBackAsItWas) {
    std::mt19937 random(11);
    State state = defaultState();
    for (int i = 0; i < 200; ++i) {
        editAtRandom(state, random);
        if (state.models.size() > 9) state.models.resize(3);
        normalise(state);
        const std::string text = workspaceJson(state);
        const State again = parseWorkspace(text, "w.json");
        ASSERT_EQ(workspaceJson(again), text);
        ASSERT_TRUE(difference(state, again).empty()) << text;
    }
}

TEST(Workspace, TheCommandLineReadsItsFile) {
    const Job job = parseJob(workspaceJson(defaultState()), "w.json");
    EXPECT_EQ(job.command, "render");
    EXPECT_EQ(sceneJson(job.scene), sceneJson(sceneOf(defaultState(), 0)));
}

TEST(Workspace, ASceneIsAWorkspace) {
    Scene scene;
    scene.model.id = "single";
    const State state = parseWorkspace(sceneJson(scene), "s.json");
    ASSERT_EQ(state.models.size(), 1u);
    EXPECT_EQ(state.models[0].model.id, "single");
}

TEST(Workspace, FaultsOfFilesAreNamedWithTheirPlace) {
    const auto with = [](const std::string& window) {
        return "{\"format\": \"searchlight-job/1\", \"command\": \"render\", \"window\": " + window + "}";
    };
    EXPECT_THAT(messageOf(with("{\"modles\": []}")), HasSubstr("w.json:1:"));
    EXPECT_THAT(messageOf(with("{\"modles\": []}")), HasSubstr("modles"));
    EXPECT_THAT(messageOf(with("{\"models\": []}")), HasSubstr("expected a list of 1 to 64 models"));
    EXPECT_THAT(messageOf(with("{\"active\": 3}")), HasSubstr("/window/active"));
    EXPECT_THAT(messageOf(with("{\"options\": {\"view\": {\"exposure\": 99}}}")), HasSubstr("exposure"));
    EXPECT_THAT(messageOf(with("7")), HasSubstr("expected an object"));
    EXPECT_THAT(messageOf("{\"format\": \"searchlight-job/1\", \"command\": \"doctor\"}"),
                HasSubstr("no scene to show"));
    EXPECT_NE(messageOf(""), "");
    EXPECT_NE(messageOf("[1, 2"), "");
}

std::string outputOf(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> part{};
    while (pipe && std::fgets(part.data(), static_cast<int>(part.size()), pipe)) text += part.data();
    if (pipe) pclose(pipe);
    return text;
}

// What the program makes of the command line is what the window shows.
TEST(CommandLine, StandsForTheSameScene) {
    const std::filesystem::path folder = SEARCHLIGHT_BINARY_DIR "/bin";
    if (!std::filesystem::exists(folder / "searchlight")) GTEST_SKIP() << "the command line is not built";
    State by_flags = defaultState();
    by_flags.scene.lights = {DirectionalLight{.direction = {-1, 0.25, 3}, .irradiance = {1, 2, 3}, .angle_deg = 2}};
    by_flags.scene.material = {.id = "", .sigma_a = {0.1, 0.2, 0.3}, .sigma_s = {1}, .g = {0.3}, .eta = 1.4};
    by_flags.scene.camera = {.azimuth_deg = -30, .elevation_deg = -5, .distance = 2.5, .target = {-0.1, 0, 0}};
    by_flags.models[0].model.parameters["Moments"] = std::string("exact");
    normalise(by_flags);
    int heredocs = 0;
    for (const State& state : {defaultState(), by_flags}) {
        std::string line = commandLine(state, {.path = "it's.png", .width = 64, .height = 48, .exposure = 1.5});
        const std::size_t end = line.find('\n');
        heredocs += end != std::string::npos;
        // --print-job stands before the text behind the command, if there is one.
        std::string text;
        if (end == std::string::npos) {
            text = outputOf("PATH=" + folder.string() + ":$PATH " + line + " --print-job");
        } else {
            text = line.substr(end + 1, line.rfind("\nEND") - end - 1);
        }
        const Job job = parseJob(text, line);
        EXPECT_EQ(sceneJson(job.scene), sceneJson(sceneOf(state, state.active))) << line;
        EXPECT_EQ(job.output, "it's.png");
        EXPECT_EQ(std::get<std::string>(job.options.at("size")), "64x48");
        EXPECT_EQ(std::get<std::string>(job.options.at("exposure")), "1.500") << "as bright as it is shown";
    }
    EXPECT_EQ(heredocs, 1) << "flags speak of all lights at once: two that differ need the job";
}

TEST(OpenPath, FilesAreKnownByTheirEndings) {
    EXPECT_EQ(kindOf("a.JSON"), FileKind::workspace);
    EXPECT_EQ(kindOf("a.obj.gz"), FileKind::shape);
    EXPECT_EQ(kindOf("a.ptc"), FileKind::shape);
    EXPECT_EQ(kindOf("a.hdr"), FileKind::picture);
    EXPECT_EQ(kindOf("a.bssrdf"), FileKind::model);
    EXPECT_EQ(kindOf("a.doc"), FileKind::unknown);
}

TEST(OpenPath, AFaultLeavesTheWorkspaceAlone) {
    QTemporaryDir folder;
    Workspace workspace;
    const std::string before = workspaceJson(workspace.state());
    for (const char* name : {"bad.json", "bad.txt", "bad.csv"}) {
        const QString path = folder.filePath(name);
        writeFile(path.toStdString(), "\x01\x02 no such thing");
        EXPECT_THROW(openPath(workspace, path), Error) << name;
    }
    EXPECT_THROW(openPath(workspace, folder.filePath("missing.obj")), Error);
    EXPECT_EQ(workspaceJson(workspace.state()), before);
}

TEST(Recovery, WhatACrashLeftIsTakenOnce) {
    QTemporaryDir folder;
    State lost = defaultState();
    lost.scene.scale = 77;
    // No process has this number: the kernel's largest is smaller.
    const QString file = folder.filePath("recovery-1999999999.json");
    writeFile(file.toStdString(), workspaceJson(lost));
    Workspace workspace;
    Recovery recovery(workspace, folder.path());
    const auto found = recovery.take();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->scene.scale, 77);
    EXPECT_FALSE(recovery.take());
}

TEST(Recovery, LeavesNothingBehindAProgramThatEnds) {
    QTemporaryDir folder;
    Workspace workspace;
    {
        Recovery recovery(workspace, folder.path());
        workspace.edit(QStringLiteral("size"), {}, [](State& state) { state.scene.scale = 5; });
        recovery.write();
        EXPECT_EQ(QDir(folder.path()).entryList(QDir::Files).size(), 1);
        EXPECT_FALSE(recovery.take()) << "this program runs: what it wrote is not what a crash left";
    }
    EXPECT_TRUE(QDir(folder.path()).entryList(QDir::Files).isEmpty());
}

}  // namespace
}  // namespace searchlight::gui
