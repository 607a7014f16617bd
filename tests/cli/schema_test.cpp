// docs/report.schema.json holds for what the program writes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/program_runner.h"

namespace nuvo::cli_test {
namespace {

using Json = nlohmann::json;

bool is_of_type(const Json& value, const std::string& type) {
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "array") return value.is_array();
    return type == "object" && value.is_object();
}

/// As much of JSON Schema 2020-12 as the schema uses; a keyword that is not known is a fault.
class Validator {
  public:
    explicit Validator(const Json& schema) : all_(schema) {}

    /// What is wrong with the value, at most one fault; empty: nothing.
    std::string fault(const Json& value) const { return fault(all_, value, "$"); }

  private:
    std::string fault(const Json& schema, const Json& value, const std::string& at) const {
        for (const auto& [keyword, rule] : schema.items()) {
            const std::string found = fault(keyword, rule, schema, value, at);
            if (!found.empty()) return found;
        }
        return {};
    }

    std::string fault(const std::string& keyword, const Json& rule, const Json& schema,
                      const Json& value, const std::string& at) const {
        const auto faulty = [&](bool is_faulty) {
            return is_faulty ? at + ": " + keyword + " " + rule.dump() + ": " + value.dump() : "";
        };
        if (keyword == "$schema" || keyword == "title" || keyword == "description" ||
            keyword == "$defs")
            return {};
        if (keyword == "$ref")
            return fault(all_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, at);
        if (keyword == "type") {
            const std::vector<std::string> types =
                rule.is_array() ? rule.get<std::vector<std::string>>()
                                : std::vector<std::string>{rule.get<std::string>()};
            return faulty(std::none_of(types.begin(), types.end(), [&](const std::string& type) {
                return is_of_type(value, type);
            }));
        }
        if (keyword == "const") return faulty(value != rule);
        if (keyword == "enum")
            return faulty(std::find(rule.begin(), rule.end(), value) == rule.end());
        if (keyword == "minimum") return faulty(value.is_number() && value < rule);
        if (keyword == "minItems") return faulty(value.is_array() && value.size() < rule);
        if (keyword == "maxItems") return faulty(value.is_array() && value.size() > rule);
        if (keyword == "oneOf") {
            std::string faults;
            std::size_t fitting = 0;
            for (const Json& one : rule) {
                const std::string found = fault(one, value, at);
                fitting += found.empty() ? 1 : 0;
                faults += found + "; ";
            }
            return fitting == 1 ? "" : at + ": oneOf: " + faults;
        }
        if (keyword == "items") return value.is_array() ? of_items(rule, value, at) : "";
        if (!value.is_object()) return {};  // what follows is about objects
        if (keyword == "required") {
            for (const Json& name : rule)
                if (!value.contains(name.get<std::string>())) return at + ": lacks " + name.dump();
            return {};
        }
        if (keyword == "properties") {
            for (const auto& [name, content] : value.items())
                if (rule.contains(name)) {
                    const std::string found = fault(rule[name], content, at + "." + name);
                    if (!found.empty()) return found;
                }
            return {};
        }
        if (keyword == "additionalProperties") {
            for (const auto& [name, content] : value.items()) {
                if (schema.contains("properties") && schema["properties"].contains(name)) continue;
                if (rule == false) return at + ": has " + name;
                const std::string found = fault(rule, content, at + "." + name);
                if (!found.empty()) return found;
            }
            return {};
        }
        return at + ": the schema has an unknown keyword " + keyword;
    }

    std::string of_items(const Json& rule, const Json& value, const std::string& at) const {
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string found = fault(rule, value[i], at + "[" + std::to_string(i) + "]");
            if (!found.empty()) return found;
        }
        return {};
    }

    const Json& all_;
};

class Schema : public ProgramTest {
  protected:
    const Json schema_ =
        Json::parse(file_text(fs::path(NUVO_SOURCE_DIR) / "docs/report.schema.json"));
};

TEST_F(Schema, HoldsForWhatEachCommandWrites) {
    put("a.x3d", kSmallScene);
    put("rays.txt", "0 0 10 0 0 -1\n");
    const std::vector<std::vector<std::string>> commands{
        {"--json=o.json"},
        {"--json=o.json", "--profile=thesis", "--rep=2"},
        {"--json=o.json", "--max-objects=1", "--precision=float", "--step=0.01", "--bias=0.5"},
        {"--json=o.json", "--type=nonuniform", "--heatmap=tests", "--planes=p", "--octree=t.json",
         "--error"},
        {"--json=o.json", "--profile=fast", "--samples=2"},
        {"--json=o.json", "--profile=fast", "--heatmap=searches"},
        {"--json=o.json", "-compare"},
        {"--json=o.json", "-compare=brute", "--profile=fast", "--planes=p"},
        {"--json=o.json", "--rays=rays.txt", "--out=answers.txt"},
        {"--json=o.json", "--rays=rays.txt", "--out=answers.txt", "--profile=fast"},
        {"--study=o.json", "--rep=2"}};
    for (std::vector<std::string> command : commands) {
        std::string all;
        for (const std::string& word : command) all += word + " ";
        SCOPED_TRACE(all);
        command.insert(command.end(), {"--file=a", "--res=16,9"});
        if (all.find("--rep") == std::string::npos) command.emplace_back("--rep=1");
        const Outcome outcome = run(command);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(Validator(schema_).fault(Json::parse(content("o.json"))), "");
    }
}

// A schema that lets all pass would hold for anything.
TEST_F(Schema, FindsWhatDoesNotBelong) {
    put("a.x3d", kSmallScene);
    ASSERT_EQ(run({"a.x3d", "--json=o.json", "--res=8,8", "--rep=1"}).exit_code, 0);
    const Json good = Json::parse(content("o.json"));
    const Validator validator(schema_);
    ASSERT_EQ(validator.fault(good), "");
    for (const auto& [name, value] : good.items()) {
        Json changed = good;
        changed[name] = Json::object({{"other", 1}});
        EXPECT_NE(validator.fault(changed), "") << name;
    }
    for (const char* needed : {"schema", "provenance", "profile", "scene", "warnings"}) {
        Json changed = good;
        changed.erase(needed);
        EXPECT_NE(validator.fault(changed), "") << needed;
    }
    Json changed = good;
    changed["tree"]["voxels"] = -1;
    EXPECT_NE(validator.fault(changed).find("minimum"), std::string::npos);
    changed = good;
    changed["more"] = 1;
    EXPECT_NE(validator.fault(changed).find("has more"), std::string::npos);
    changed = good;
    changed["profile"]["walk"] = "jump";
    EXPECT_NE(validator.fault(changed).find("enum"), std::string::npos);
}

// Another program's opinion of the same, where Debian's python3-jsonschema is.
TEST_F(Schema, IsOneForOtherValidatorsToo) {
    if (std::system("python3 -c 'import jsonschema' 2>/dev/null") != 0)
        GTEST_SKIP() << "needs python3-jsonschema";
    put("a.x3d", kSmallScene);
    ASSERT_EQ(run({"a.x3d", "--json=o.json", "--res=8,8", "--rep=1"}).exit_code, 0);
    const std::string check =
        "python3 -c 'import json, sys, jsonschema\n"
        "schema, value = (json.load(open(f)) for f in sys.argv[1:])\n"
        "jsonschema.Draft202012Validator.check_schema(schema)\n"
        "jsonschema.Draft202012Validator(schema).validate(value)\n"
        "value[\"more\"] = 1\n"
        "sys.exit(jsonschema.Draft202012Validator(schema).is_valid(value))' '" NUVO_SOURCE_DIR
        "/docs/report.schema.json' '" +
        (folder_ / "o.json").string() + "'";
    EXPECT_EQ(std::system(check.c_str()), 0);
}

}  // namespace
}  // namespace nuvo::cli_test
