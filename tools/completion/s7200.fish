# Completion of s7200 for fish. What may be typed is for the command itself to say.
function __s7200_candidates
    set -l words (commandline -opc) (commandline -ct)
    $words[1] complete -- $words[2..-1] 2>/dev/null
end
complete -c s7200 -f -n 'count (__s7200_candidates) >/dev/null' -a '(__s7200_candidates)'
