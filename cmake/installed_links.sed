# SPDX-License-Identifier: Apache-2.0
# In pages that are installed: links to what lies elsewhere than in the repository.
s,](LICENSE),](copyright),g
s,](CHANGELOG\.md),](changelog.gz),g
s,](\.\./scenes/,](../../../mirrorball/scenes/,g
s,](\([a-z]*\.schema\.json\)),](../../../mirrorball/schemas/\1),g
