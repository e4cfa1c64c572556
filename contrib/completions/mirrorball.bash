# SPDX-License-Identifier: Apache-2.0
_mirrorball() {
    local IFS=$'\n' word words=()
    for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do
        [[ $word == = ]] || words+=("$word")  # of --math=strict, bash makes three words
    done
    [[ $word != = ]] || words+=('')
    COMPREPLY=($(command "${COMP_WORDS[0]}" --complete "${words[@]}" 2>/dev/null | cut -f 1))
}
complete -o default -F _mirrorball mirrorball
