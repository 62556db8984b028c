# Completion of s7200 for bash. What may be typed is for the command itself to say.
_s7200() {
  local word line typed joins='' words=()
  COMPREPLY=()
  # To bash = and : are words of their own: --cpu = 2, westinghouse : pc1200
  for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
    case $word in
      =) joins='' ;;
      :) typed+=: joins=1 ;;
      *) if [ "$joins" ]; then typed+=$word joins=''; else words+=(${typed:+"$typed"}) typed=$word; fi ;;
    esac
  done
  [ "${COMP_WORDS[COMP_CWORD]}" != = ] || { words+=(${typed:+"$typed"}); typed=''; }
  words+=("$typed")
  while IFS= read -r line; do
    line=${line%%$'\t'*}
    COMPREPLY+=("${line#"${typed%"${typed##*:}"}"}")
  done < <("$1" complete -- "${words[@]}" 2>/dev/null)
}
complete -o default -F _s7200 s7200
