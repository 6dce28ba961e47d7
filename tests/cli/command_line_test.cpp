/// Tests the command line of `fase`: help, refusals, closed or full streams.
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

TEST(CommandLine, HelpAndVersionGoToStandardOutput) {
    const Outcome version = run_fase({"--version"});
    EXPECT_EQ(version.code, 0);
    EXPECT_TRUE(version.out.starts_with("fase ")) << version.out;
    const Outcome help = run_fase({"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    for (const char* command : {"run", "view", "info", "generate", "distance", "impact", "pairs", "query"}) {
        EXPECT_NE(help.out.find(std::string("\n  ") + command), std::string::npos) << command;
        const Outcome own = run_fase({command, "--help"});
        EXPECT_EQ(own.code, 0);
        EXPECT_NE(own.out.find("Example"), std::string::npos) << command;
        EXPECT_NE(own.out.find(std::string("  fase ") + command), std::string::npos) << command;
    }
}

TEST(CommandLine, EachExampleOfTheHelpIsAccepted) {
    // Only parses the commands: the files do not exist.
    for (const char* command : {"run", "view", "info", "generate", "distance", "impact", "pairs", "query"}) {
        const std::string help = run_fase({command, "--help"}).out;
        std::size_t examples = 0;
        const std::string mark = std::string("\n  fase ") + command;
        for (std::size_t i = help.find(mark); i != std::string::npos; i = help.find(mark, i + 1)) {
            std::vector<std::string> words;
            std::string line = help.substr(i + 3, help.find('\n', i + 1) - i - 3), word;
            for (const char c : line + " ") {
                if (c != ' ') word += c;
                if (c == ' ' && !word.empty()) words.push_back(std::exchange(word, {}));
            }
            words.erase(words.begin());
            words.push_back("--help");  // stops after parsing
            EXPECT_EQ(run_fase(words).code, 0) << line;
            ++examples;
        }
        EXPECT_GE(examples, 1u) << command;
    }
}

TEST(CommandLine, InvalidArgumentsAreRefusedAndNamed) {
    struct Case {
        std::vector<std::string> arguments;
        std::string words;
    };
    const std::vector<Case> cases{
        {{}, "COMMAND: found none"},
        {{"jump"}, "jump: found an unknown command; expected one of run, view"},
        {{"--loud"}, "--loud: found an unknown option"},
        {{"run"}, "SCENE"},
        {{"run", ""}, "SCENE: found \"\""},
        {{"run", "stack", "more"}, "more: found an unknown argument"},
        {{"run", "stack", "--loud"}, "--loud: found an unknown option"},
        {{"run", "stack", "--steps"}, "--steps: found no value"},
        {{"run", "stack", "--steps", "1e999"}, "--steps: found \"1e999\"; expected a whole number"},
        {{"run", "stack", "--steps", "-5"}, "--steps: found \"-5\""},
        {{"run", "stack", "--steps", "12abc"}, "--steps: found \"12abc\""},
        {{"run", "stack", "--steps", ""}, "--steps: found \"\""},
        {{"run", "stack", "--steps", " 5"}, "--steps: found \" 5\""},
        {{"run", "stack", "--steps", "18446744073709551617"}, "--steps: found \"18446744073709551617\""},
        {{"run", "stack", "--steps", "1", "--steps", "2"}, "--steps: found several times"},
        {{"run", "stack", "--steps", "1", "--seconds", "2"},
         "--seconds: found --steps with it; expected one of the two"},
        {{"run", "stack", "--seconds", "1e999"}, "--seconds: found \"1e999\"; expected a number above 0"},
        {{"run", "stack", "--seconds", "-5"}, "--seconds: found \"-5\""},
        {{"run", "stack", "--seconds", "0"}, "--seconds: found \"0\""},
        {{"run", "stack", "--seconds", "nan"}, "--seconds: found \"nan\""},
        {{"run", "stack", "--seconds", "0x10"}, "--seconds: found \"0x10\""},
        {{"run", "stack", "--dt", "2"}, "--dt: found \"2\""},
        {{"run", "stack", "--threads", "1025"}, "--threads: found \"1025\""},
        {{"run", "stack", "--record", ""}, "--record: found \"\""},
        {{"run", "stack", "--contacts"}, "--contacts: found no --record; expected both"},
        {{"view", "x", "--port", "65536"}, "--port: found \"65536\""},
        {{"generate", "castle"}, "--output"},
        {{"distance"}, "PAIRS.json"},
        {{"impact"}, "DIR"},
        {{"info", "a\nb", "c\x1b[31m\xff"}, "c\\x1b[31m\\xff: found an unknown argument"},
    };
    for (const Case& one : cases) {
        const Outcome outcome = run_fase(one.arguments);
        expect_error_line(outcome, 2, one.words);
        EXPECT_NE(outcome.err.find("--help"), std::string::npos) << outcome.err;
    }
}

TEST(CommandLine, OptionsWithoutEffectAreRefused) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_fase({"generate", "stack", "--count", "2", "-o", folder / "s.glb"}).code, 0);
    ASSERT_EQ(run_fase({"generate", "uniform", "--count", "9", "--frames", "2", "-o", folder / "t.aabt"}).code, 0);
    write_file(folder / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_file(folder / "m.wad", "PWAD");
    write_file(folder / "sizes.txt", "3 4\n");
    const std::string scene = folder / "s.glb", trace = folder / "t.aabt", wad = folder / "m.wad",
                      mesh = folder / "m.obj", sizes = folder / "sizes.txt";
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"run", scene, "--count", "9"}, "--count: found a scene file; expected a kind of 'fase generate' or a WAD"},
        {{"run", scene, "--seed", "1"}, "--seed: found a scene file"},
        {{"run", scene, "--map", "E1M1"}, "--map: found a scene that is not a WAD"},
        {{"run", "stack", "--durable"}, "--durable: found no --record; expected both"},
        {{"view", "x", "--port", "0", "--html", folder / "x.html"},
         "--html: found --port with it; expected one of the two"},
        {{"view", "x", "--port", "0", "--glb", folder / "x.glb"}, "--glb: found --port with it"},
        {{"generate", "stack", "--frames", "3", "-o", folder / "x.glb"}, "--frames: found a scene"},
        {{"pairs", trace, "--limit", "3"}, "--limit: found a single structure; expected --structure all or --mix"},
        {{"atlas", "--rects", sizes, "--trim"}, "--trim: found --rects with it"},
        {{"atlas", "--rects", sizes, "--array"}, "--array: found --rects with it"},
        {{"atlas", "--rects", sizes, "--tries", "3", "--budget-ms", "3"}, "--budget-ms: found --tries with it"},
        {{"level", wad, "--gl"}, "--gl: found no --output"},
        {{"level", wad, "--extended"}, "--extended: found no --output"},
        {{"level", wad, "--heights"}, "--heights: found no --pvs and no --point"},
        {{"level", wad, "--rays", "3"}, "--rays: found no --pvs"},
        {{"level", wad, "--lumps", "gl", "--weight", "1"}, "--weight: found --lumps with it"},
        {{"level", wad, "--lumps", "gl", "--effort", "quick"}, "--effort: found --lumps with it"},
        {{"level", mesh, "--stats"}, "--stats: found a mesh; expected a WAD"},
    };
    for (const auto& [arguments, words] : cases) expect_error_line(run_fase(arguments), 2, words);
}

TEST(CommandLine, OutputsWithAnotherExtensionAreRefusedBeforeAnyWork) {
    const TemporaryFolder folder;
    // Inputs that do not exist show that nothing is read before.
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"run", "no.glb", "--record", "bad.mp4"},
         "bad.mp4: found the extension \".mp4\"; expected .faserec for a recording"},
        {{"run", "no.glb", "--record", "bad"}, "bad: found no extension; expected .faserec for a recording"},
        {{"run", "no.glb", "--trace", "t.faserec"}, "found the extension \".faserec\"; expected .aabt for a trace"},
        {{"view", "no.faserec", "--html", "a.htm"}, "found the extension \".htm\"; expected .html for a page"},
        {{"view", "no.faserec", "--glb", "a.txt"}, "found the extension \".txt\"; expected .glb for an animation"},
        {{"level", "no.wad", "--svg", "a.bmp"}, "found the extension \".bmp\"; expected .svg for a drawing"},
        {{"level", "no.wad", "--png", "a.svg"}, "found the extension \".svg\"; expected .png for an image"},
        {{"level", "no.wad", "-o", "a.lmp"}, "found the extension \".lmp\"; expected .wad for a WAD"},
        {{"draw", "no.aabt", "-o", "a.png"}, "found the extension \".png\"; expected .svg for a drawing"},
        {{"generate", "rain", "-o", "x.glb"}, "x.glb: found a scene's extension; rain is a trace, which needs .aabt"},
        {{"generate", "castle", "-o", "x.aabt"},
         "found a trace's extension; castle is a scene, which needs .glb or .gltf"},
        {{"atlas", "no.png", "-o", "x.png"}, "--output: found \"x.png\"; expected the NAME of NAME.png and NAME.json"},
    };
    for (const auto& [arguments, words] : cases) {
        const std::string go = "cd '" + folder.path() + "' && exec \"$0\" \"$@\"";
        expect_error_line(RunningFase::by_shell(go, arguments).wait(), 2, words);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CommandLine, AHugeArgumentIsTruncatedInTheMessage) {
    const std::string huge(120000, 'a');  // the system limit for one argument is 128 KiB
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{huge}, {"run", "stack", "--" + huge}, {"run", "stack", "--steps", huge}}) {
        const Outcome outcome = run_fase(arguments);
        expect_error_line(outcome, 2, "aaaa…");
        EXPECT_LT(outcome.err.size(), 400u);
    }
    std::vector<std::string> many(17, huge);  // 2 MiB in total
    many.insert(many.begin(), {"run", "stack"});
    const Outcome outcome = run_fase(many);
    expect_error_line(outcome, 2, "found an unknown argument");
    EXPECT_LT(outcome.err.size(), 400u);
}

TEST(CommandLine, APathWithControlCharactersWorksAndIsEscapedInOutput) {
    const TemporaryFolder folder;
    const std::string strange = folder / "a\n\t\x1b[1m\xff.glb";
    ASSERT_EQ(run_fase({"generate", "stack", "--count", "2", "-o", strange}).code, 0);
    for (const char* command : {"run", "info"}) {
        std::vector<std::string> arguments{command, strange};
        if (command == std::string("run")) arguments.insert(arguments.end(), {"--steps", "1"});
        const Outcome outcome = run_fase(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
        EXPECT_EQ(outcome.out.find('\xff'), std::string::npos);
    }
    const Outcome json = run_fase({"run", strange, "--steps", "1", "--json"});
    EXPECT_TRUE(scene::parse_json(json.out)) << json.out;
    const Outcome missing = run_fase({"run", folder / "b\n\x1b\xff.glb"});
    expect_error_line(missing, 3, "b\\n\\x1b\\xff.glb");
}

TEST(CommandLine, ANameThatBeginsWithADashIsAFileAfterADoubleDash) {
    const TemporaryFolder folder;
    const std::string go = "cd '" + folder.path() + "' && exec \"$0\" \"$@\"";
    EXPECT_EQ(RunningFase::by_shell(go, {"generate", "stack", "--count", "2", "--output=-x.glb"}).wait().code, 0);
    EXPECT_EQ(RunningFase::by_shell(go, {"run", "--steps", "1", "--", "-x.glb"}).wait().code, 0);
}

TEST(CommandLine, AClosedStandardOutputIsNotAnError) {
    const TemporaryFolder folder;
    const std::string recording = folder / "r.faserec";
    const Outcome closed = RunningFase({"run", "stack", "--steps", "5", "--record", recording}, "closed").wait();
    EXPECT_EQ(closed.code, 0);
    EXPECT_EQ(closed.err, "");
    const Outcome info = run_fase({"info", recording, "--json"});
    EXPECT_NE(info.out.find("\"complete\": true"), std::string::npos) << info.out;
}

TEST(CommandLine, AReaderThatClosesThePipeEndsItQuietly) {
    for (const char* option : {"--help", "--version"}) {
        const Outcome outcome = RunningFase::by_shell("\"$0\" \"$@\" | true; exit 0", {option}).wait();
        EXPECT_EQ(outcome.code, 0);
        EXPECT_EQ(outcome.err, "");
    }
    const Outcome outcome =
        RunningFase::by_shell("{ \"$0\" \"$@\"; echo $? >&2; } | true", {"run", "stack", "--steps", "500"}).wait();
    EXPECT_EQ(outcome.err, "141\n");
}

TEST(CommandLine, AFullStandardOutputIsAnError) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"run", "stack", "--steps", "1"},
                                                      {"run", "stack", "--steps", "1", "--json"},
                                                      {"--help"}}) {
        const Outcome outcome = RunningFase(arguments, "/dev/full").wait();
        expect_error_line(outcome, 3, "standard output: cannot write: No space left");
    }
}

}  // namespace
}  // namespace fase::cli
