!> A parameter study as data: a base case, what is varied, and what is wanted of every run.
module study_definition
  use gudgeon_kinds, only: dp
  implicit none
  private
  public :: study_t, parameter_t, text_t

  !> A text of its own length.
  type :: text_t
    character(len=:), allocatable :: text
  end type text_t

  !> One key that is varied: over a range, or a list.
  type :: parameter_t
    character(len=:), allocatable :: key    !! GROUP.KEY
    real(dp) :: from = 0, to = 0
    integer :: count = 0                    !! points of a range on a grid
    logical :: is_log = .false.             !! the points are even in the logarithm
    type(text_t), allocatable :: list(:)    !! values as written; empty: a range
  end type parameter_t

  type :: study_t
    character(len=:), allocatable :: name, file     !! NAME of its results; path as given, for messages
    character(len=:), allocatable :: title
    character(len=:), allocatable :: case           !! path of the base case
    character(len=:), allocatable :: table          !! path of the table of runs; empty: a design over parameters
    character(len=:), allocatable :: design
    integer :: runs = 0, seed = 0                   !! of a sampled design
    integer :: settle_cycles = 0                    !! revolutions at the start that the statistics leave out
    character(len=:), allocatable :: traces
    logical :: cycles = .false.                     !! the statistics of every revolution too
    real(dp) :: strobe_angle_deg = 0
    character(len=:), allocatable :: strobe_columns !! empty: no strobe
    integer :: strobe_cycles = 0                    !! strobes of a run; 0: all
    type(parameter_t), allocatable :: parameters(:)
    character(len=:), allocatable :: resolved       !! a study file with every default that gives the same study
    character(len=:), allocatable :: identity       !! the same without title and paths
  end type study_t
end module study_definition
