!> Reads the command line: options, overrides and case files. The arguments are passed as an array so that it can be tested.
module command_line
  use error_handling, only: error_t, fail, status_command_line
  use text_tools, only: printable, is_clean, lowercase, nearest_word, likely_word, case_name, joined
  use case_templates, only: template_kinds
  use accuracy_presets, only: accuracy_levels
  use case_schema, only: key_table_t, case_schema_of, find_group, group_names, is_listed
  use report_files, only: ending_of_results
  implicit none
  private
  public :: command_line_t, parse_command_line, program_arguments, help_text, option_t, options, subjects, shells, &
    progress_words, languages

  !> The contents of the command line.
  type :: command_line_t
    integer, private :: option_count = 0
    character(len=:), allocatable :: out          !! folder for results
    character(len=:), allocatable :: overrides(:) !! GROUP.KEY=VALUE or GROUP=none in the given order, padded with blanks
    character(len=:), allocatable :: name         !! of the results, instead of that of the case file; empty: not given
    character(len=:), allocatable :: from         !! path of a state from which the cases start; empty: none
    character(len=:), allocatable :: accuracy     !! one of `accuracy_levels`, or empty: as in the case file
    integer :: jobs = 0                           !! number of processes; 0: number of processors
    logical :: certify = .false.                  !! make certificates of the runs
    character(len=:), allocatable :: reference    !! page of the manual to print: one of `subjects` or a group of cases; empty: none
    character(len=:), allocatable :: kind         !! of a short template; empty: the complete one
    character(len=:), allocatable :: completion   !! shell whose completion script is printed; empty: none
    logical :: manual = .false.                   !! print the page of the manual
    logical :: resolved = .false.                 !! print the complete cases instead of running them
    logical :: check = .false., template = .false., quiet = .false., help = .false., version = .false.
    character(len=:), allocatable :: progress     !! auto, always, never
    character(len=:), allocatable :: language     !! of outcomes: one of `languages`
    character(len=:), allocatable :: cases(:)     !! paths of case files or study files, padded with blanks
    logical :: sweep = .false.                    !! the files are studies
    logical :: fresh = .false.                    !! start a sweep again from the beginning
    integer :: first_row = 1, last_row = 0        !! range of runs of a sweep; last_row 0: to the end
  end type command_line_t

  !> An option: its names, and whether it has a value.
  type :: option_t
    character(len=10) :: long = ''
    character(len=1) :: short = ''
    logical :: takes_value = .false.
    logical :: may_take_value = .false.   !! in the form --NAME=VALUE alone
  end type option_t

  type(option_t), parameter :: options(20) = [ &
    option_t('out', 'o', .true.), option_t('set', 's', .true.), option_t('accuracy', 'a', .true.), &
    option_t('jobs', 'j', .true.), option_t('progress', '', .true.), option_t('language', '', .true.), &
    option_t('check', '', .false.), option_t('resolved', '', .false.), &
    option_t('certify', '', .false.), option_t('name', '', .true.), &
    option_t('template', '', .false., .true.), option_t('quiet', 'q', .false.), option_t('help', 'h', .false.), &
    option_t('version', 'V', .false.), option_t('fresh', '', .false.), option_t('rows', '', .true.), &
    option_t('reference', '', .true.), option_t('from', '', .true.), option_t('completion', '', .true.), &
    option_t('man', '', .false.)]

  character(len=*), parameter :: subjects = 'case, study, oils, results, schema'   !! of --reference, beside groups
  character(len=*), parameter :: shells = 'bash, zsh, fish'                   !! of --completion
  character(len=*), parameter :: progress_words = 'auto, always, never'       !! of --progress
  character(len=*), parameter :: languages = 'en, pt'                         !! of --language
  character(len=*), parameter :: chunks = '.chunks'   !! ending of the folder in which a study collects results
  character(len=*), parameter :: standard_input = '/dev/stdin'
  integer, parameter :: most_jobs = 1024

contains

  !> Convert arguments to a command line. Errors are one line with a hint, and have the exit status of the command line.
  subroutine parse_command_line(arguments, line, error)
    character(len=*), intent(in) :: arguments(:)
    type(command_line_t), intent(out) :: line
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: text
    logical :: only_cases
    integer :: i   ! the last argument used
    line%out = 'results'
    line%accuracy = ''
    line%from = ''
    line%progress = 'auto'
    line%language = 'en'
    line%reference = ''
    line%name = ''
    line%kind = ''
    line%completion = ''
    allocate (character(len=len(arguments)) :: line%overrides(0), line%cases(0))
    only_cases = .false.
    i = 0
    do while (i < size(arguments) .and. .not. allocated(error))
      i = i + 1
      text = trim(arguments(i))
      if (text == '') then
        call refuse(error, 'an empty argument is no case file')
      else if (text == 'sweep' .and. .not. (line%sweep .or. only_cases) .and. size(line%cases) == 0) then
        line%sweep = .true.
      else if (text == '-') then
        line%cases = [character(len=max(len(arguments), len(standard_input))) :: line%cases, standard_input]
      else if (text == 'plot' .and. .not. only_cases .and. size(line%cases) == 0) then
        call refuse(error, 'plot stands before all options: gudgeon plot WHAT [RUN ...]')
      else if (only_cases .or. index(text, '-') /= 1) then
        line%cases = [character(len=max(len(arguments), len(standard_input))) :: line%cases, text]
      else if (text == '--') then
        only_cases = .true.
      else if (index(text, '--') == 1) then
        call read_long_option(arguments, i, line, error)
      else
        call read_short_options(arguments, i, line, error)
      end if
    end do
    if (.not. (allocated(error) .or. line%help .or. line%version)) call check_line(line, error)
  end subroutine parse_command_line

  !> Check that the options belong together.
  subroutine check_line(line, error)
    type(command_line_t), intent(in) :: line
    type(error_t), allocatable, intent(inout) :: error
    if (line%template .or. line%manual .or. line%reference//line%completion /= '') then
      if (line%template .and. line%kind == '' .and. line%option_count == 1 .and. size(line%cases) == 1 .and. &
          all(index(line%cases, '.') == 0)) then
        call refuse(error, '--template '//printable(trim(line%cases(1)), 60)// &
          ': a kind stands behind =: --template=KIND, one of '//template_kinds)
      else if (line%option_count > 1 .or. size(line%cases) > 0) then
        call refuse(error, '--template, --reference, --completion and --man are not combined with other options or with files')
      else if (line%sweep .and. line%kind /= '') then
        call refuse(error, 'gudgeon sweep --template has no kinds')
      end if
      return
    end if
    if (size(line%cases) == 0) then
      call refuse(error, 'no '//trim(merge('study', 'case ', line%sweep))//' file given')
    else if (line%name /= '' .and. (line%sweep .or. size(line%cases) > 1)) then
      call refuse(error, '--name is for one case')
    else if (line%sweep .and. (line%certify .or. line%resolved)) then
      call refuse(error, '--certify and --resolved are not for gudgeon sweep')
    else if (line%sweep .and. line%from /= '') then
      call refuse(error, '--from is not for gudgeon sweep: give &initial from in the base case')
    else if (.not. line%sweep .and. (line%fresh .or. line%last_row > 0)) then
      call refuse(error, '--fresh and --rows are for gudgeon sweep')
    else if (line%fresh .and. line%last_row > 0) then
      call refuse(error, '--fresh would discard the results of other rows: not with --rows')
    else
      call check_names(line, error)
    end if
  end subroutine check_line

  !> An error of the command line.
  subroutine refuse(error, message)
    type(error_t), allocatable, intent(inout) :: error
    character(len=*), intent(in) :: message
    call fail(error, message//'; gudgeon --help lists the options', status_command_line)
  end subroutine refuse

  !> `--name`, `--name value` or `--name=value`.
  subroutine read_long_option(arguments, i, line, error)
    character(len=*), intent(in) :: arguments(:)
    integer, intent(inout) :: i   !! the last argument used
    type(command_line_t), intent(inout) :: line
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: text, name, near
    character(len=10) :: names(size(options))
    integer :: equals, place
    text = trim(arguments(i))
    equals = index(text, '=')
    name = text(3:)
    if (equals > 0) name = text(3:equals - 1)
    place = findloc(options%long == name, .true., 1)
    if (place == 0) then
      names = options%long
      near = nearest_word(name, names)
      if (near /= '') near = '; did you mean --'//near//'?'
      call refuse(error, '--'//printable(name, 40)//': unknown option'//near)
    else if (equals == 0) then
      call read_option(arguments, i, line, error, options(place))
    else if (options(place)%takes_value .or. options(place)%may_take_value) then
      call set_option(line, error, options(place)%long, text(equals + 1:), has_value=.true.)
    else
      call refuse(error, '--'//name//': takes no value')
    end if
  end subroutine read_long_option

  !> `-s VALUE`, `-sVALUE`, `-q`, or several options without values together, such as `-qh`.
  subroutine read_short_options(arguments, i, line, error)
    character(len=*), intent(in) :: arguments(:)
    integer, intent(inout) :: i   !! the last argument used
    type(command_line_t), intent(inout) :: line
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: text
    integer :: k, place
    text = trim(arguments(i))
    do k = 2, len(text)
      place = findloc(options%short == text(k:k) .and. options%short /= '', .true., 1)
      if (place == 0) then
        call refuse(error, printable(text, 40)//': unknown option')
      else if (options(place)%takes_value .and. k < len(text)) then
        call set_option(line, error, options(place)%long, text(k + 1:))
        return
      else
        call read_option(arguments, i, line, error, options(place))
      end if
      if (allocated(error)) return
    end do
  end subroutine read_short_options

  !> Carry out an option to which no value is attached: if it takes one, that is the next argument.
  subroutine read_option(arguments, i, line, error, option)
    character(len=*), intent(in) :: arguments(:)
    integer, intent(inout) :: i   !! the last argument used
    type(command_line_t), intent(inout) :: line
    type(error_t), allocatable, intent(inout) :: error
    type(option_t), intent(in) :: option
    if (.not. option%takes_value) then
      call set_option(line, error, option%long, '')
    else if (i == size(arguments)) then   ! is told what is wanted
      call set_option(line, error, option%long, '')
    else
      i = i + 1
      call set_option(line, error, option%long, trim(arguments(i)))
    end if
  end subroutine read_option

  !> Carry out one option.
  subroutine set_option(line, error, name, value, has_value)
    type(command_line_t), intent(inout) :: line
    type(error_t), allocatable, intent(inout) :: error
    character(len=*), intent(in) :: name, value
    logical, intent(in), optional :: has_value   !! of an option that may do without
    character(len=:), allocatable :: wanted
    line%option_count = line%option_count + 1
    select case (name)
    case ('out')
      line%out = value
      if (value == '') wanted = 'must name a folder'
    case ('set')
      if (.not. is_override(value)) wanted = 'must have the form GROUP.KEY=VALUE or GROUP=none'
      line%overrides = [character(len=len(line%overrides)) :: line%overrides, value]
    case ('from')
      line%from = value
      if (value == '') wanted = 'must name a file'
    case ('accuracy')
      line%accuracy = value
      if (.not. is_listed(value, accuracy_levels)) &
        wanted = 'must be one of '//accuracy_levels//likely_word(value, accuracy_levels)
    case ('jobs')
      line%jobs = 0
      if (value /= '' .and. verify(value, '0123456789') == 0 .and. len(value) < 6) read (value, *) line%jobs
      if (line%jobs < 1 .or. line%jobs > most_jobs) wanted = 'must be a whole number from 1 to 1024'
    case ('progress')
      line%progress = value
      if (.not. is_listed(value, progress_words)) wanted = 'must be auto, always or never'
    case ('language')
      line%language = value
      if (.not. is_listed(value, languages)) wanted = 'must be en or pt'
    case ('check')
      line%check = .true.
    case ('resolved')
      line%check = .true.
      line%resolved = .true.
    case ('template')
      line%template = .true.
      line%kind = value
      if (present(has_value) .and. .not. is_listed(value, template_kinds)) &
        wanted = 'must be one of '//template_kinds//likely_word(value, template_kinds)
    case ('name')
      line%name = value
      if (value == '' .or. index(value, '/') > 0 .or. value == '.' .or. value == '..') &
        wanted = 'must be a name without folder; --out gives the folder'
      if (index(value, '-') == 1) wanted = 'must not begin with -'
      if (.not. is_clean(value)) wanted = 'must not contain control characters or bytes that are not UTF-8'
    case ('reference')
      line%reference = value
      call check_subject(value, wanted)
    case ('completion')
      line%completion = value
      if (.not. is_listed(value, shells)) wanted = 'must be bash, zsh or fish'
    case ('man')
      line%manual = .true.
    case ('quiet')
      line%quiet = .true.
    case ('certify')
      line%certify = .true.
    case ('fresh')
      line%fresh = .true.
    case ('rows')
      call read_rows(value, line%first_row, line%last_row)
      if (line%last_row == 0) wanted = 'must have the form A:B, 1 <= A <= B'
    case ('help')
      line%help = .true.
    case default
      line%version = .true.
    end select
    if (allocated(wanted)) call refuse(error, trim('--'//trim(name)//' '//printable(value, 60))//': '//wanted)
  end subroutine set_option

  !> What the subject of --reference must be, if it is not that.
  subroutine check_subject(value, wanted)
    character(len=*), intent(in) :: value
    character(len=:), allocatable, intent(inout) :: wanted
    type(key_table_t) :: table
    character(len=:), allocatable :: groups
    call case_schema_of(table)
    groups = joined(group_names(table%groups))
    if (.not. is_listed(value, subjects) .and. find_group(table%groups, value) == 0 .and. &
        find_group(table%groups, value//'_1') == 0) &
      wanted = 'must be '//subjects//' or a group of cases: '//groups//likely_word(value, subjects//', '//groups)
  end subroutine check_subject

  !> Check that no two files would have results of the same name, as a/x.nml and b/x.nml, and that no name ends as those of the
  !> results of another one.
  subroutine check_names(line, error)
    type(command_line_t), intent(in) :: line
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: one, path, ending
    integer :: first, second
    one = ''
    path = ''
    ending = ''
    do first = 1, size(line%cases)
      path = printable(trim(line%cases(first)), 100)
      one = case_name(trim(line%cases(first)))
      do second = first + 1, size(line%cases)
        if (one /= case_name(trim(line%cases(second)))) cycle
        call fail(error, path//' and '//printable(trim(line%cases(second)), 100)// &
          ': their results would have the same names; run them separately with --out', status_command_line)
        return
      end do
      if (line%name /= '') one = line%name
      ending = ending_of_results(one)
      if (line%sweep) ending = ''
      if (line%sweep .and. index(one, chunks, back=.true.) == max(2, len(one) - len(chunks) + 1)) ending = chunks
      if (ending == '') cycle
      call fail(error, path//': '//printable(one(:len(one) - len(ending)), 100)//' has results whose names begin with '// &
        printable(one, 100)//': give another name'//trim(merge('            ', ' with --name', line%sweep)), &
        status_command_line)
      return
    end do
  end subroutine check_names

  !> Whether a text has the form GROUP.KEY=VALUE or GROUP=none.
  pure logical function is_override(text)
    character(len=*), intent(in) :: text
    integer :: dot, equals
    equals = index(text, '=')
    dot = index(text(:max(0, equals - 1)), '.', back=.true.)
    is_override = dot > 1 .and. equals > dot + 1
    if (equals > 1 .and. dot == 0) is_override = lowercase(trim(adjustl(text(equals + 1:)))) == 'none'
  end function is_override

  !> Read A:B as two whole numbers; `last` is 0 if the text has another form.
  pure subroutine read_rows(value, first, last)
    character(len=*), intent(in) :: value
    integer, intent(out) :: first, last
    integer :: colon
    first = 1
    last = 0
    colon = index(value, ':')
    if (verify(value, '0123456789:') > 0 .or. colon < 2 .or. colon > 9 .or. len(value) - colon < 1 .or. &
        len(value) - colon > 8 .or. index(value, ':', back=.true.) /= colon) return
    read (value(:colon - 1), *) first
    read (value(colon + 1:), *) last
    if (first < 1 .or. first > last) last = 0
  end subroutine read_rows

  !> The arguments of this program.
  function program_arguments() result(arguments)
    character(len=:), allocatable :: arguments(:)
    integer :: i, length, longest
    longest = 1
    do i = 1, command_argument_count()
      call get_command_argument(i, length=length)
      longest = max(longest, length)
    end do
    allocate (character(len=longest) :: arguments(command_argument_count()))
    do i = 1, size(arguments)
      call get_command_argument(i, value=arguments(i))
    end do
  end function program_arguments

  !> The text of --help.
  pure function help_text() result(text)
    character(len=:), allocatable :: text
    character(len=*), parameter :: n = achar(10)
    text = 'gudgeon [options] CASE.nml [CASE.nml ...]'//n// &
      'gudgeon sweep [options] STUDY.nml [STUDY.nml ...]'//n// &
      'gudgeon plot WHAT [RUN ...]'//n// &
      'Simulates the slider-crank mechanism with clearance in its joints. sweep runs parameter studies; plot is'//n// &
      'gudgeon-plot, which draws results.'//n// &
      'CASE.nml is a case file, or - for standard input.'//n//n// &
      '  -o, --out DIR             folder for the results (default: results)'//n// &
      '  -s, --set GROUP.KEY=VALUE change a value of the case; repeatable, the last one counts. A new end of the run'//n// &
      '                            (revolutions, crank_revolutions or end_time) replaces the one in the file, but for'//n// &
      '                            until = ''periodic'', which needs --set run.until=end. GROUP.KEY[2]: a number of a list'//n// &
      '      --set GROUP=none      remove a group from the case; a later --set of one of its keys starts an empty group'//n// &
      '  -a, --accuracy LEVEL      draft, standard or reference: about 3, 5 or 8 digits of a motion without impacts. Sets'//n// &
      '                            method auto, contact entry root and the tolerance 1e-4, 1e-6 or 1e-10; --set has'//n// &
      '                            priority. dissertation: Adams, tolerance 1e-6, contact entry by step rejection'//n// &
      '      --name NAME           name of the results of a case, instead of that of its file'//n// &
      '      --from STATE.nml      go on from the state that another run has reached; with --set initial.goes_on=.false.'//n// &
      '                            begin at t = 0 with its motion'//n// &
      '  -j, --jobs N              number of processes for cases and studies (default: number of processors)'//n// &
      '      --certify             estimate the accuracy of each case by running it again at a hundredth of its tolerance'//n// &
      '                            and with another method; results in the summary and in CASE.certificate.csv'//n// &
      '      --check               read and validate the cases without running them'//n// &
      '      --resolved            print the cases with all defaults, as in CASE.resolved.nml, without running them'//n// &
      '      --template            print a complete, commented case file (sweep: study file) with every key'//n// &
      '      --template=KIND       print a short case that runs; KIND is one of '//template_kinds//n// &
      '      --reference SUBJECT   print a reference page in Markdown; SUBJECT is case, study, oils,'//n// &
      '                            results, a group of cases, or schema: a JSON Schema of cases'//n// &
      '      --completion SHELL    print what completes this command line in bash, zsh or fish'//n// &
      '      --man                 print the manual page'//n// &
      '      --progress WHEN       show progress on standard error: auto (on a terminal), always or never'//n// &
      '      --language LANGUAGE   of --check and of the line of a run or study: en or pt; messages and notes are English'//n// &
      '  -q, --quiet               print errors only'//n// &
      '      --fresh               sweep: discard the results of an earlier sweep (default: continue it)'//n// &
      '      --rows A:B            sweep: run only the rows A to B; a later sweep joins them with the others'//n// &
      '  -h, --help                print this text'//n// &
      '  -V, --version             print the version'//n//n// &
      'Results of CASE.nml: CASE.csv (trace), CASE.events.csv (contacts), CASE.summary.csv, CASE.state.nml (the state at'//n// &
      'the end, from which --from goes on), CASE.resolved.nml (the case with all defaults).'//n// &
      'Results of STUDY.nml: STUDY.runs.csv, one row for each run, and STUDY.study.nml.'//n// &
      'Exit status: 0 all done; 1 internal error; 2 wrong command line; 3 wrong case file; 4 an integration'//n// &
      'could not continue (sweep: in at least one run); 5 a result could not be written.'//n
  end function help_text
end module command_line
