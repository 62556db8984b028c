# Completion of s7200 for bash. What may be typed is for the command itself to say.
_s7200() {
  local word line words=()
  COMPREPLY=()
  # To bash an = is a word of its own: --cpu = 2
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
    [ "$word" = = ] || words+=("$word")
  done
  [ "${COMP_WORDS[COMP_CWORD]}" != = ] || words+=('')
  while IFS= read -r line; do
    COMPREPLY+=("${line%%$'\t'*}")
  done < <("$1" complete -- "${words[@]}" 2>/dev/null)
}
complete -o default -F _s7200 s7200
