# SPDX-License-Identifier: Apache-2.0
function __mirrorball
    set -l words (commandline -opc) (commandline -ct)
    set -l offered (command $words[1] --complete $words[2..-1] 2>/dev/null)
    if test -n "$offered"
        printf '%s\n' $offered
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c mirrorball -f -a '(__mirrorball)'
