#include "apps/postrender_completion.h"

#include <iostream>
#include <sstream>
#include <vector>

#include "core/base/channels.h"
#include "core/base/error.h"

namespace nullcone {

namespace {

/// What stands after an option.
struct Value {
  std::string option, kind;  ///< kind: "set", "words", or an ending of files, or "" for any file
  std::string words = {};
};

std::string channel_words() {
  std::string out;
  const auto add = [&](const auto& list) {
    for (const ChannelInfo& channel : list) out += (out.empty() ? "" : " ") + std::string(channel.name);
  };
  add(kHitChannelInfo);
  add(kRayChannelInfo);
  return out;
}

std::vector<Value> values() {
  return {{"--set", "set"},
          {"--look", "json"},
          {"--output", ""},
          {"--movie", "mp4"},
          {"--bits", "words", "8 16 32"},
          {"--show", "words", channel_words()},
          {"--completion", "words", "bash zsh"}};
}

/// All names of an option that is shown in the help: "-o", "--output".
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> out;
  if (option.get_group().empty() || option.get_positional()) return out;
  for (const std::string& name : option.get_snames()) out.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) out.push_back("--" + name);
  return out;
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

void replace(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

constexpr const char* kBash = R"script(# bash completion: source <(nullcone-postrender --completion bash)
_nullcone_postrender() {
  local words=("${COMP_WORDS[@]}") at=$COMP_CWORD data='' look='' i
  local cur=${words[at]} path=''
  COMPREPLY=()
  # The value after path=: bash splits words at "=".
  if [[ $cur == = && ${words[at - 2]} == --set ]]; then
    path=${words[at - 1]}= cur=''
  elif [[ ${words[at - 1]} == = && ${words[at - 3]} == --set ]]; then
    path=${words[at - 2]}=
  fi
  if [[ -n $path || ${words[at - 1]} == --set ]]; then
    for ((i = 1; i < at; ++i)); do
      case ${words[i - 1]} in
        --look) look=${words[i]} ;;
        -o | --output | --movie | --set | =) ;;
        *) [[ ${words[i]} == *.exr && -z $data ]] && data=${words[i]} ;;
      esac
    done
    # Of a sequence, the first file that is there.
    [[ $data == *'#'* ]] && data=$(compgen -G "${data//'#'/[0-9]}" | sort | head -n 1)
    [[ $look == *'#'* ]] && look=$(compgen -G "${look//'#'/[0-9]}" | sort | head -n 1)
    [[ -n $data ]] || return
    mapfile -t COMPREPLY < <("${words[0]}" "$data" ${look:+--look "$look"} --complete-set "$path$cur" 2>/dev/null |
      while IFS= read -r i; do [[ $i == "$path$cur"* ]] && printf '%s\n' "${i#"$path"}"; done)
    [[ ${COMPREPLY[0]} == *[./=] ]] && compopt -o nospace
    return
  fi
  case ${words[at - 1]} in
@CASES@  esac
  if [[ $cur == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W '@OPTIONS@' -- "$cur")
  else
    compopt -o filenames
    mapfile -t COMPREPLY < <(compgen -d -- "$cur"; compgen -f -X '!*.exr' -- "$cur")
  fi
}
complete -F _nullcone_postrender nullcone-postrender
)script";

constexpr const char* kZsh = R"script(#compdef nullcone-postrender
# zsh completion: nullcone-postrender --completion zsh >FOLDER/_nullcone-postrender, with FOLDER in fpath
_nullcone-postrender_set() {
  local data='' look='' i
  local -a found
  for ((i = 2; i < CURRENT; ++i)); do
    case ${words[i - 1]} in
      --look) look=${(Q)words[i]} ;;
      -o | --output | --movie | --set) ;;
      *) [[ ${words[i]} == *.exr && -z $data ]] && data=${(Q)words[i]} ;;
    esac
  done
  # Of a sequence, the first file that is there.
  [[ $data == *'#'* ]] && found=(${~${data//'#'/[0-9]}}(N)) && data=${found[1]}
  [[ $look == *'#'* ]] && found=(${~${look//'#'/[0-9]}}(N)) && look=${found[1]}
  [[ -n $data ]] || return 1
  found=(${(f)"$(${(Q)words[1]} $data ${look:+--look} ${look:+$look} --complete-set "${(Q)PREFIX}" 2>/dev/null)"})
  compadd -Q -S '' -- $found
}
_nullcone-postrender() {
  _arguments -s \
@OPTIONS@    '1:dataset:_files -g "*.exr"'
}
if [[ $funcstack[1] == _nullcone-postrender ]]; then
  _nullcone-postrender "$@"
else
  compdef _nullcone-postrender nullcone-postrender
fi
)script";

std::string bash_script(const CLI::App& app) {
  std::string options, with_value, cases;
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string> names = names_of(*option);
    std::string either;
    for (const std::string& name : names) {
      options += (options.empty() ? "" : " ") + name;
      either += (either.empty() ? "" : " | ") + name;
    }
    if (names.empty() || is_flag(*option)) continue;
    std::string action = "return";  // a number, say
    for (const Value& value : values()) {
      if (value.option != names.back() || value.kind == "set") continue;
      action =
          value.kind == "words"
              ? "mapfile -t COMPREPLY < <(compgen -W '" + value.words + "' -- \"$cur\"); return"
              : "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$cur\"; compgen -f -X '!*" +
                    (value.kind.empty() ? "" : "." + value.kind) + "' -- \"$cur\"); return";
    }
    cases += "    " + either + ") " + action + " ;;\n";
  }
  std::string out = kBash;
  replace(out, "@OPTIONS@", options);
  replace(out, "@CASES@", cases);
  return out;
}

std::string zsh_script(const CLI::App& app) {
  std::string options;
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string> names = names_of(*option);
    if (names.empty()) continue;
    std::string told = option->get_description(), action;
    for (const auto& [what, by] : {std::pair{"'", "’"}, {"[", "("}, {"]", ")"}, {":", " -"}})
      replace(told, what, by);
    if (!is_flag(*option)) action = ":value: ";
    for (const Value& value : values()) {
      if (value.option != names.back()) continue;
      if (value.kind == "set")
        action = ":path=value:_nullcone-postrender_set";
      else if (value.kind == "words")
        action = ":value:(" + value.words + ")";
      else
        action = value.kind.empty() ? ":file:_files" : ":file:_files -g \"*." + value.kind + "\"";
    }
    const bool again = option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
    for (const std::string& name : names)
      options += "    '" + std::string(again ? "*" : "") + name + "[" + told + "]" + action + "' \\\n";
  }
  std::string out = kZsh;
  replace(out, "@OPTIONS@", options);
  return out;
}

}  // namespace

int print_completion(const CLI::App& app, const std::string& shell) {
  if (shell != "bash" && shell != "zsh")
    throw InputError("--completion", "'" + printable(shell, 40) + "' is unknown; expected bash or zsh");
  std::cout << (shell == "bash" ? bash_script(app) : zsh_script(app));
  return 0;
}

}  // namespace nullcone
