#compdef mirrorball
# SPDX-License-Identifier: Apache-2.0
local -a offered
offered=(${(f)"$(command ${(Q)words[1]} --complete "${(@Q)words[2,CURRENT]}" 2>/dev/null)"})
offered=("${offered[@]//:/\\:}")
offered=("${offered[@]/$'\t'/:}")
if (( $#offered )); then _describe mirrorball offered; else _files; fi
